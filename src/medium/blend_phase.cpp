#include "medium/blend_phase.h"

#include <algorithm>
#include <stdexcept>

#include "core/rng.h"

namespace turbid {

BlendPhase::BlendPhase(std::shared_ptr<const PhaseFunction> first, std::shared_ptr<const PhaseFunction> second, float w)
    : first_(std::move(first)), second_(std::move(second)), w_(w) {
  if (!(w >= 0 && w <= 1)) throw std::invalid_argument("the weight of a blend of phase functions must lie in [0, 1]");
}

float BlendPhase::sample(float u) const {
  if (u < w_) return second_->sample(std::min(u / w_, kOneMinusEpsilon));
  return first_->sample(std::min((u - w_) / (1 - w_), kOneMinusEpsilon));
}

std::vector<float> BlendPhase::landmarks() const {
  std::vector<float> both = first_->landmarks();
  const std::vector<float> others = second_->landmarks();
  both.insert(both.end(), others.begin(), others.end());
  return both;
}

}  // namespace turbid
