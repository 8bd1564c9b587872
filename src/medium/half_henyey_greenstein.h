#pragma once
#include <algorithm>

#include "core/vector.h"
#include "medium/phase_function.h"

namespace turbid {

/// The part of a Henyey-Greenstein phase function that lies in one hemisphere, normalised there (S3 sect. 3.4,
/// NUMERICS 1): forward, f(mu) = C (1 + g^2 - 2 g mu)^(-3/2) for mu >= 0, else 0; backward the same for mu <= 0, which
/// is the mirror image of the forward part of -g.
///
/// Written in m = mu and h = g forward, m = -mu and h = -g backward. With S = sqrt(1 + h^2) and S - 1 = h^2 / (S + 1)
/// no formula divides by h or cancels, so none needs a series: they serve from g = 0 (uniform in the hemisphere) to
/// both ends.
class HalfHenyeyGreensteinPhase final : public PhaseFunction {
 public:
  enum class Hemisphere { kForward, kBackward };

  /// Throws std::invalid_argument unless -1 < g < 1.
  HalfHenyeyGreensteinPhase(float g, Hemisphere side);

  float eval(float mu) const override { return side_ * mu >= 0 ? at(std::max(0.0f, 1 - side_ * mu)) : 0; }
  float eval_angle(float theta) const override;
  float sample(float u) const override;
  float mean_cosine() const override { return mean_cosine_; }
  std::vector<float> landmarks() const override;

 private:
  float at(float one_minus_m) const;

  float side_;             ///< 1 forward, -1 backward
  float two_h_;            ///< 2 h
  float one_minus_h_, s_;  ///< 1 - h; S
  float k_;                ///< (1 + h / (S + 1)) / S
  float constant_;         ///< C, 1/sr
  float mean_cosine_;
};

}  // namespace turbid
