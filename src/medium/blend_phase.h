#pragma once
#include <memory>

#include "medium/phase_function.h"

namespace turbid {

/// f = (1 - w) first + w second. Sampling rescales its one number to pick one of the two and to sample it.
class BlendPhase : public PhaseFunction {
 public:
  /// Throws std::invalid_argument unless 0 <= w <= 1.
  BlendPhase(std::shared_ptr<const PhaseFunction> first, std::shared_ptr<const PhaseFunction> second, float w);

  float eval(float mu) const override { return (1 - w_) * first_->eval(mu) + w_ * second_->eval(mu); }
  float eval_angle(float theta) const override {
    return (1 - w_) * first_->eval_angle(theta) + w_ * second_->eval_angle(theta);
  }
  float sample(float u) const override;
  float mean_cosine() const override { return (1 - w_) * first_->mean_cosine() + w_ * second_->mean_cosine(); }
  std::vector<float> landmarks() const override;

 private:
  std::shared_ptr<const PhaseFunction> first_, second_;
  float w_;
};

}  // namespace turbid
