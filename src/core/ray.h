#pragma once
#include "core/vector.h"

namespace turbid {

/// Points origin + t * direction with 0 <= t < t_max. The direction is a unit vector, so t is a distance.
struct Ray {
  Vec3 origin;
  Vec3 direction;
  float t_max = kInfinity;

  Vec3 at(float t) const { return origin + direction * t; }
};

}  // namespace turbid
