#pragma once
#include "core/transform.h"

namespace turbid {

/// Axis-aligned box around a box that is taken through an affine map.
inline Bounds3 bounds_of_mapped(const Bounds3& box, const Transform& map) {
  Bounds3 bounds;
  for (int corner = 0; corner < 8; ++corner)
    bounds.extendBy(map.point(
        {corner & 1 ? box.max.x : box.min.x, corner & 2 ? box.max.y : box.min.y, corner & 4 ? box.max.z : box.min.z}));
  return bounds;
}

/// World-space box around the cube [0,1]^3 of local coordinates.
inline Bounds3 bounds_of_unit_cube(const Transform& to_world) { return bounds_of_mapped({Vec3(0), Vec3(1)}, to_world); }

}  // namespace turbid
