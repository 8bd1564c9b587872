#pragma once
#include <numbers>

#include "core/rng.h"
#include "core/vector.h"

namespace turbid::testing {

/// Photons for tests alone: each starts anew, in double precision, by other formulas than the program's.

/// A direction whose angle to `d` has Henyey-Greenstein's distribution.
inline Imath::V3d deflect(const Imath::V3d& d, double g, Rng& rng) {
  const double u = rng.next_double(), phi = 2 * std::numbers::pi * rng.next_double();
  const double q = (1 - g * g) / (1 - g + 2 * g * u);
  const double mu = g == 0 ? 1 - 2 * u : (1 + g * g - q * q) / (2 * g);
  const Imath::V3d helper = std::abs(d.x) < 0.5 ? Imath::V3d(1, 0, 0) : Imath::V3d(0, 1, 0);
  const Imath::V3d s = d.cross(helper).normalized(), t = d.cross(s);
  const double sine = std::sqrt(std::max(0.0, 1 - mu * mu));
  return (s * (sine * std::cos(phi)) + t * (sine * std::sin(phi)) + d * mu).normalized();
}

/// A photon that collides at the origin, having travelled along +z, or sets out there (`ray`); mean free path 1. Calls
/// visit(place, direction after it, weight) for its third collision and those after. Every photon survives its first
/// three collisions, later ones by chance.
template <class Visit>
void follow_photon(double g, double albedo, Rng& rng, const Visit& visit, bool ray = false) {
  Imath::V3d x(0), d(0, 0, 1);
  if (ray) x = d * -std::log(1 - rng.next_double());
  const double weight = albedo * albedo * albedo;
  for (int n = 1; n <= 3 || rng.next_double() < albedo; ++n) {
    const Imath::V3d out = deflect(d, g, rng);
    if (n >= 3) visit(x, out, weight);
    d = out;
    x += d * -std::log(1 - rng.next_double());
  }
}

}  // namespace turbid::testing
