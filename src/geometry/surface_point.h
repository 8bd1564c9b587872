#pragma once
#include <cstdint>

#include "core/frame.h"

namespace turbid {

/// A point on a surface, with what shading needs of its neighbourhood. World space.
struct SurfacePoint {
  Vec3 p;           ///< position
  float error = 0;  ///< bound on the rounding error of p along ng (a length)
  Vec3 ng;          ///< geometric normal, unit, on the outside of the shape
  Frame shading;    ///< shading.n: interpolated normal, unit, in the hemisphere of ng; s along dp_du where that exists
  Vec2 uv;          ///< surface parameters, for textures
  Vec3 dp_du, dp_dv;       ///< partial derivatives of p by uv
  uint32_t primitive = 0;  ///< triangle of a mesh; 0 for other shapes
  Vec2 barycentric;        ///< weights (b1, b2) of the triangle's second and third vertex, for mesh attributes

  Vec3 to_local(const Vec3& v) const { return shading.to_local(v); }
  Vec3 to_world(const Vec3& v) const { return shading.to_world(v); }

  /// Origin of a ray that leaves the surface in `direction`: moved off the surface along ng, to the side of the
  /// direction, by just more than the rounding error of p, so that the ray starts on the right side without skipping
  /// anything.
  Vec3 leave(const Vec3& direction) const;
};

}  // namespace turbid
