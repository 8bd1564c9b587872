#include "refraction/facet.h"

namespace turbid {
namespace {
bool usable(const Vec3& n) { return std::isfinite(n.x + n.y + n.z) && length_squared(n) > 0; }
}  // namespace

Facet facet_of(const TriangleMesh& mesh, uint32_t triangle) {
  const MeshData& data = mesh.data();
  const uint32_t* i = &data.indices[3 * size_t{triangle}];
  Facet facet;
  facet.p0 = V3d(data.positions[i[0]]);
  facet.p_a = V3d(data.positions[i[1]]) - facet.p0;
  facet.p_b = V3d(data.positions[i[2]]) - facet.p0;
  const V3d across = facet.p_a.cross(facet.p_b);
  facet.area2 = across.length();
  facet.ng = across / facet.area2;
  facet.n0 = facet.ng;
  if (!mesh.has_vertex_normals()) return facet;
  const auto normal = [&](size_t k) {
    const Vec3& n = data.normals[i[k]];
    return usable(n) ? V3d(n) : facet.ng;
  };
  facet.n0 = normal(0);
  facet.n_a = normal(1) - facet.n0;
  facet.n_b = normal(2) - facet.n0;
  return facet;
}

bool shades_with_blend(const Facet& facet, const V2d& at) {
  constexpr double kLeastCosine = 1e-3;  // of bend_to_front
  return facet.normal(at).dot(facet.ng) > kLeastCosine;
}

}  // namespace turbid
