#pragma once
#include <algorithm>

#include "core/vector.h"
#include "medium/phase_function.h"

namespace turbid {

/// Henyey & Greenstein 1941: f(mu) = (1 - g^2) / (4 pi (1 + g^2 - 2 g mu)^(3/2)), -1 < g < 1, mean of mu = g.
///
/// Both functions are written in a = |g| and m = sign(g) mu, in a form without cancellation, so that one formula serves
/// from g = 0 (where it is the isotropic one) up to |g| -> 1. What remains is the resolution of mu itself: the peak is
/// (1 - a)^2 wide in 1 - m, and a float mu next to 1 has steps of 6e-8, so beyond |g| = 0.999 most deflections round to
/// 0. eval_angle() resolves them.
class HenyeyGreensteinPhase final : public PhaseFunction {
 public:
  /// Throws std::invalid_argument unless -1 < g < 1.
  explicit HenyeyGreensteinPhase(float g);

  float eval(float mu) const override { return at(std::max(0.0f, 1 - sign_ * mu)); }

  float eval_angle(float theta) const override {
    return at(2 * sqr(sign_ > 0 ? std::sin(theta / 2) : std::cos(theta / 2)));
  }

  /// Inverts the CDF. With D = 1 - a + 2 a u the textbook's m = (1 + a^2 - ((1 - a^2) / D)^2) / (2 a) becomes
  /// 1 - m = 2 ((1 - a) / D)^2 (1 - u) (1 + a u), which needs no division by a.
  float sample(float u) const override {
    const float ratio = one_minus_a_ / (one_minus_a_ + two_a_ * u);
    const float one_minus_m = 2 * sqr(ratio) * (1 - u) * (1 + 0.5f * two_a_ * u);
    return sign_ * std::max(-1.0f, 1 - one_minus_m);
  }

  float mean_cosine() const override { return g_; }

 private:
  float at(float one_minus_m) const {
    // 1 + g^2 - 2 g mu = (1 - a)^2 + 2 a (1 - m)
    const float squared = sqr(one_minus_a_) + two_a_ * one_minus_m;
    return numerator_ / (squared * std::sqrt(squared));
  }

  float g_, sign_, two_a_, one_minus_a_, numerator_;
};

}  // namespace turbid
