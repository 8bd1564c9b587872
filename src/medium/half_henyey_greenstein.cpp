#include "medium/half_henyey_greenstein.h"

#include <cmath>
#include <stdexcept>
#include <string>

namespace turbid {

HalfHenyeyGreensteinPhase::HalfHenyeyGreensteinPhase(float g, Hemisphere side)
    : side_(side == Hemisphere::kForward ? 1.0f : -1.0f), two_h_(2 * side_ * g) {
  if (!(std::abs(g) < 1))
    throw std::invalid_argument("the g of half a Henyey-Greenstein phase function must lie between -1 and 1, " +
                                std::to_string(g) + " does not");
  // With a = 1/S, b = 1/(1 - h): b - a = h (1 + h/(S + 1)) / ((1 - h) S), and C = h / (2 pi (b - a)).
  const double h = static_cast<double>(side_ * g), s = std::sqrt(1 + h * h), bracket = 1 + h / (s + 1);
  one_minus_h_ = static_cast<float>(1 - h);
  s_ = static_cast<float>(s);
  k_ = static_cast<float>(bracket / s);
  constant_ = static_cast<float>((1 - h) * s / (2 * std::numbers::pi * bracket));
  // Mean of m = (1 + h^2 - y^-2) / (2 h), y uniform in [a, b]: that of y^-2 is 1/(a b) = S (1 - h).
  mean_cosine_ = side_ * static_cast<float>(s * bracket / 2);
}

float HalfHenyeyGreensteinPhase::at(float one_minus_m) const {
  const float squared = sqr(one_minus_h_) + two_h_ * one_minus_m;  // 1 + h^2 - 2 h m
  return constant_ / (squared * std::sqrt(squared));
}

float HalfHenyeyGreensteinPhase::eval_angle(float theta) const {
  const bool forward = theta <= kPi / 2;
  if (forward != (side_ > 0)) return 0;
  return at(2 * sqr(forward ? std::sin(theta / 2) : std::cos(theta / 2)));
}

float HalfHenyeyGreensteinPhase::sample(float u) const {
  // y = a + (b - a) xi turns into 1/y = (1 - h) / (1 - h k v), v = 1 - xi, and m = (1 + h^2 - y^-2) / (2 h) into
  // 1 - m = (1 - h)^2 k v (2 - h k v) / (2 (1 - h k v)^2). As h -> 1 the divisor is taken from its other end, v = 1,
  // where it is (1 - h) / S.
  const float xi = side_ > 0 ? u : 1 - u, v = side_ > 0 ? 1 - u : u;
  const float hk = two_h_ * 0.5f * k_, divisor = one_minus_h_ / s_ + hk * xi;
  const float one_minus_m = 0.5f * sqr(one_minus_h_ / divisor) * k_ * v * (2 - hk * v);
  return side_ * std::clamp(1 - one_minus_m, 0.0f, 1.0f);
}

std::vector<float> HalfHenyeyGreensteinPhase::landmarks() const {
  return {kPi / 2, std::nextafter(kPi / 2, kPi)};  // the last angle forward, the first one backward
}

}  // namespace turbid
