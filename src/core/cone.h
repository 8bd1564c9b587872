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
  Vec3 axis{0, 0, 1};                    ///< unit
  double half_angle = std::numbers::pi;  ///< radians; pi: all directions
  double cosine = -1;                    ///< of half_angle

  Cone() = default;
  Cone(const Vec3& towards, double angle) : axis(towards), half_angle(angle), cosine(std::cos(angle)) {}

  bool is_everything() const { return half_angle >= std::numbers::pi; }
  /// Of any length.
  bool contains(const Vec3& direction) const {
    return is_everything() ||
           static_cast<double>(dot(axis, direction)) >= cosine * static_cast<double>(length(direction));
  }
};

}  // namespace turbid
