#include "medium/draine.h"

#include <cmath>
#include <stdexcept>
#include <string>

#include "core/rng.h"

namespace turbid {

DrainePhase::DrainePhase(float g, float alpha)
    : hg_(g), g_(g), alpha_(alpha), scale_(1 / (1 + alpha * (1 + 2 * g * g) / 3)) {
  if (!(alpha >= 0) || !std::isfinite(alpha))
    throw std::invalid_argument("the alpha of a Draine phase function must be at least 0 and finite, " +
                                std::to_string(alpha) + " is not");
}

/// Draws v, the number from which Henyey-Greenstein is to be sampled: as a function of it the density is
/// scale (1 + alpha m^2), which is far from 0, so the inversion is well-behaved however narrow the peak is.
///
/// With a = |g|, b = 1 - a, c = 2 (1 + a^2), D = b + 2 a v, the sampled cosine is m = (-b^2 + b c v + a c v^2) / D^2,
/// and the integral of m^2 from 0 to v is the rational function that follows, e = c - 2 a (to be checked by
/// differentiation: it satisfies Q' D - 6 a Q = (m D^2)^2 for its numerator Q). Nothing divides by a.
float DrainePhase::sample(float u) const {
  const double a = std::abs(static_cast<double>(g_)), b = 1 - a, c = 2 * (1 + a * a), e = c - 2 * a;
  const auto alpha = static_cast<double>(alpha_);
  const double target = static_cast<double>(u) * (1 + alpha * (1 + 2 * a * a) / 3);
  double low = 0, high = 1, v = static_cast<double>(u);
  for (int i = 0; i < 60; ++i) {
    const double d = b + 2 * a * v;
    const double numerator = v * (b * (b * (b - e * v) + e * e * v * v / 3) + c * c * a * v * v * v / 2);
    const double m = (-b * b + c * v * (b + a * v)) / (d * d);
    const double excess = v + alpha * numerator / (d * d * d) - target;
    (excess > 0 ? high : low) = v;
    double next = v - excess / (1 + alpha * m * m);
    if (!(next > low && next < high)) next = (low + high) / 2;
    const double step = std::abs(next - v);
    v = next;
    if (step < 0x1p-17 * v) break;  // the error is about the square of the last step
  }
  return hg_.sample(std::min(static_cast<float>(v), kOneMinusEpsilon));
}

float DrainePhase::mean_cosine() const {
  // Henyey-Greenstein's mean of mu^3 is g (3 + 2 g^2) / 5.
  return g_ * scale_ * (1 + alpha_ * (3 + 2 * g_ * g_) / 5);
}

}  // namespace turbid
