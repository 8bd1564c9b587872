#pragma once
#include <optional>

#include "core/ray.h"

namespace turbid {

/// Where two pieces of rays pass each other nearest.
struct BeamCrossing {
  float on_first, on_second;  ///< distances along them
  float sine;                 ///< of the angle between them
};

/// Empty where the lines pass each other at `radius` or farther, beyond an end, or are parallel. In double precision:
/// radii are small against distances.
inline std::optional<BeamCrossing> find_crossing(const Ray& first, const Ray& second, float radius) {
  const Imath::V3d a(first.direction), b(second.direction), w = Imath::V3d(second.origin) - Imath::V3d(first.origin);
  const Imath::V3d normal = a.cross(b);
  const double sine2 = normal.length2(), reach = w.dot(normal);
  constexpr double kParallel = 1e-14;
  if (sine2 < kParallel || !(sqr(reach) < sqr(static_cast<double>(radius)) * sine2)) return std::nullopt;
  const double t = w.cross(b).dot(normal) / sine2, s = w.cross(a).dot(normal) / sine2;
  if (!(t > 0) || !(t < static_cast<double>(first.t_max)) || !(s > 0) || !(s < static_cast<double>(second.t_max)))
    return std::nullopt;
  return BeamCrossing{static_cast<float>(t), static_cast<float>(s), static_cast<float>(std::sqrt(sine2))};
}

}  // namespace turbid
