#pragma once
#include <cmath>

#include "core/vector.h"

namespace turbid {

/// The angle between two vectors of any length, radians. By its sine and cosine: neither loses digits near 0 or pi.
inline double angle_between(const Vec3& a, const Vec3& b) {
  return std::atan2(static_cast<double>(length(cross(a, b))), static_cast<double>(dot(a, b)));
}

/// Directions within an angle of an axis.
struct Cone {
  Vec3 axis{0, 0, 1};      ///< unit
  float half_angle = kPi;  ///< radians; pi: all directions

  bool contains(const Vec3& direction) const {
    return half_angle >= kPi || angle_between(axis, direction) <= static_cast<double>(half_angle);
  }
};

}  // namespace turbid
