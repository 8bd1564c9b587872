#include "geometry/mesh_data.h"

#include <utility>

#include "core/parallel.h"

namespace turbid {
namespace {
constexpr size_t kGrain = 4096;  // vertices or triangles per task: enough work to be worth one

void reverse_windings(MeshData& mesh) {
  for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) std::swap(mesh.indices[i + 1], mesh.indices[i + 2]);
}
}  // namespace

void transform_mesh(MeshData& mesh, const Transform& to_world) {
  parallel_for(
      mesh.positions.size(), [&](size_t i) { mesh.positions[i] = to_world.point(mesh.positions[i]); }, kGrain);
  parallel_for(
      mesh.normals.size(),
      [&](size_t i) {
        const Vec3 n = to_world.normal(mesh.normals[i]);
        const float norm = length(n);
        mesh.normals[i] = norm > 0 ? n * (1 / norm) : Vec3(0.0f);
      },
      kGrain);
  if (to_world.flips_handedness()) reverse_windings(mesh);
}

void compute_vertex_normals(MeshData& mesh) {
  mesh.normals.assign(mesh.positions.size(), Vec3(0.0f));
  const auto angle = [](const Vec3& a, const Vec3& b, float cross_length) {
    return std::atan2(cross_length, dot(a, b));
  };
  for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const uint32_t i0 = mesh.indices[i], i1 = mesh.indices[i + 1], i2 = mesh.indices[i + 2];
    const Vec3 e01 = mesh.positions[i1] - mesh.positions[i0], e12 = mesh.positions[i2] - mesh.positions[i1],
               e20 = mesh.positions[i0] - mesh.positions[i2];
    const Vec3 n = cross(e01, -e20);
    const float twice_area = length(n);
    if (!(twice_area > 0)) continue;
    const Vec3 unit = n * (1 / twice_area);
    mesh.normals[i0] += unit * angle(e01, -e20, twice_area);
    mesh.normals[i1] += unit * angle(e12, -e01, twice_area);
    mesh.normals[i2] += unit * angle(e20, -e12, twice_area);
  }
  for (Vec3& n : mesh.normals) {
    const float norm = length(n);
    n = norm > 0 ? n * (1 / norm) : Vec3(0.0f);
  }
}

void flip_mesh(MeshData& mesh) {
  reverse_windings(mesh);
  for (Vec3& n : mesh.normals) n = -n;
}

}  // namespace turbid
