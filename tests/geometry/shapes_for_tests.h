#pragma once
#include <memory>
#include <string>
#include <vector>

#include "core/rng.h"
#include "core/warp.h"
#include "geometry/basic_meshes.h"
#include "geometry/cylinder.h"
#include "geometry/disk.h"
#include "geometry/generated.h"
#include "geometry/ray_caster.h"
#include "geometry/sphere.h"
#include "geometry/triangle_mesh.h"

namespace turbid::testing {

inline std::shared_ptr<const Shape> mesh_shape(MeshData data, bool flip_normals = false) {
  return std::make_shared<TriangleMesh>(std::move(data), flip_normals);
}

inline Vec2 random_square(Rng& rng) {
  const float x = rng.next_float();
  return {x, rng.next_float()};
}

inline Vec3 random_direction(Rng& rng) { return square_to_sphere(random_square(rng)); }

inline Vec3 random_in(const Bounds3& b, Rng& rng) {
  Vec3 p;
  for (int i = 0; i < 3; ++i) p[i] = b.min[i] + (b.max[i] - b.min[i]) * rng.next_float();
  return p;
}

/// Moves and scales a mesh.
inline MeshData placed(MeshData mesh, double scale, const Imath::V3d& offset) {
  transform_mesh(mesh, Transform::translate(offset.x, offset.y, offset.z) * Transform::scale(scale, scale, scale));
  return mesh;
}

}  // namespace turbid::testing
