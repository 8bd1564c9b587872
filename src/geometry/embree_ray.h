#pragma once
#include <embree3/rtcore_ray.h>

#include "core/ray.h"

namespace turbid {

/// A ray for Embree's queries, from 0 to `t_max` in lengths of its direction.
inline RTCRay embree_ray(const Ray& ray, float t_max) {
  const Vec3 &o = ray.origin, &d = ray.direction;
  return {o.x, o.y, o.z, 0, d.x, d.y, d.z, 0, t_max, ~0u, 0, 0};
}

}  // namespace turbid
