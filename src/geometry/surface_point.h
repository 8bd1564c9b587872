#pragma once
#include <cstdint>

#include "core/frame.h"

namespace turbid {

class TriangleMesh;

/// True when `direction` leads to the outside of a surface with geometric normal ng. The same in every place that asks:
/// the products are exact in double, so the compiler cannot round them differently here and there, as it may with
/// dot(). The medium behind a boundary and the side that a ray starts on must both be decided by this.
inline bool leads_outside(const Vec3& ng, const Vec3& direction) {
  return double{ng.x} * double{direction.x} + double{ng.y} * double{direction.y} + double{ng.z} * double{direction.z} >
         0;
}

/// A point on a surface, with what shading needs of its neighbourhood. World space.
struct SurfacePoint {
  Vec3 p;           ///< position
  float error = 0;  ///< bound on the rounding error of p along ng (a length)
  Vec3 ng;          ///< geometric normal, unit, on the outside of the shape
  Frame shading;    ///< shading.n: interpolated normal, unit, in the hemisphere of ng; s along dp_du where that exists
  Vec2 uv;          ///< surface parameters, for textures
  Vec3 dp_du, dp_dv;       ///< partial derivatives of p by uv
  uint32_t primitive = 0;  ///< triangle of a mesh; 0 for other shapes
  Vec2 barycentric{0, 0};  ///< weights (b1, b2) of the triangle's second and third vertex, for mesh attributes
  const TriangleMesh* mesh = nullptr;  ///< that the point lies on, for its attributes; null for other shapes

  Vec3 to_local(const Vec3& v) const { return shading.to_local(v); }
  Vec3 to_world(const Vec3& v) const { return shading.to_world(v); }

  /// Origin of a ray that leaves the surface in `direction`: moved off the surface along ng, to the side of the
  /// direction, by just more than the rounding error of p, so that the ray starts on the right side without skipping
  /// anything.
  Vec3 leave(const Vec3& direction) const;
};

}  // namespace turbid
