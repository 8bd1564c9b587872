#include "geometry/basic_meshes.h"

namespace turbid {
namespace {
/// Appends the square centre +- du +- dv with uv [0,1]^2 growing along du and dv, and the given normal, one of +- du x
/// dv.
void add_square(MeshData& mesh, const Vec3& centre, const Vec3& du, const Vec3& dv, const Vec3& n) {
  const auto first = static_cast<uint32_t>(mesh.positions.size());
  const bool mirrored = dot(cross(du, dv), n) < 0;
  for (const Vec2& uv : {Vec2(0, 0), Vec2(1, 0), Vec2(1, 1), Vec2(0, 1)}) {
    mesh.positions.push_back(centre + du * (2 * uv.x - 1) + dv * (2 * uv.y - 1));
    mesh.normals.push_back(n);
    mesh.uvs.push_back(uv);
  }
  for (const uint32_t i : {0u, 1u, 2u, 0u, 2u, 3u}) mesh.indices.push_back(first + (mirrored ? 3 - i : i));
}
}  // namespace

MeshData make_rectangle(const Transform& to_world) {
  MeshData mesh;
  mesh.name = "rectangle";
  add_square(mesh, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1});
  transform_mesh(mesh, to_world);
  return mesh;
}

MeshData make_cube(const Transform& to_world) {
  MeshData mesh;
  mesh.name = "cube";
  // Directions in which u and v grow on each face, as in Mitsuba 3: mirrored, seen from outside.
  add_square(mesh, {0, -1, 0}, {0, 0, 1}, {1, 0, 0}, {0, -1, 0});
  add_square(mesh, {0, 1, 0}, {-1, 0, 0}, {0, 0, -1}, {0, 1, 0});
  add_square(mesh, {1, 0, 0}, {0, 1, 0}, {0, 0, -1}, {1, 0, 0});
  add_square(mesh, {0, 0, 1}, {0, 1, 0}, {1, 0, 0}, {0, 0, 1});
  add_square(mesh, {-1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, 0, 0});
  add_square(mesh, {0, 0, -1}, {0, -1, 0}, {1, 0, 0}, {0, 0, -1});
  transform_mesh(mesh, to_world);
  return mesh;
}

}  // namespace turbid
