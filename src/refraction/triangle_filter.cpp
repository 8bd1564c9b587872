#include "refraction/triangle_filter.h"

#include <limits>

#include "refraction/quadratic.h"
#include "refraction/wide.h"

namespace turbid {
namespace {

using namespace wide;

/// A row for each coordinate of a corner, of its position and of its normal.
struct Corners {
  alignas(64) float position[3][3][kLanes], normal[3][3][kLanes];

  void set(size_t corner, size_t lane, const Vec3& p, const Vec3& n) {
    for (int k = 0; k < 3; ++k) {
      position[corner][k][lane] = p[k];
      normal[corner][k][lane] = n[k];
    }
  }
};

/// The corners of triangles; the first of them where there are fewer than lanes.
Corners gather(const TriangleMesh& mesh, std::span<const uint32_t> triangles) {
  const MeshData& data = mesh.data();
  const bool smooth = mesh.has_vertex_normals();
  Corners corners;
  for (size_t lane = 0; lane < kLanes; ++lane) {
    const uint32_t* i = &data.indices[3 * size_t{triangles[lane < triangles.size() ? lane : 0]}];
    for (size_t k = 0; k < 3; ++k) corners.set(k, lane, data.positions[i[k]], smooth ? data.normals[i[k]] : Vec3(0));
  }
  return corners;
}

}  // namespace

uint32_t TriangleFilter::may_contribute(std::span<const uint32_t> triangles) const {
  const Corners corners = gather(mesh_, triangles);
  Vector positions[3], normals[3];
  for (size_t k = 0; k < 3; ++k) positions[k] = load(corners.position[k]);
  const Vector p_a = positions[1] - positions[0], p_b = positions[2] - positions[0];
  const Vector geometric = unit(cross(p_a, p_b)) * all(sign_);
  const Vector towards = light_.at_infinity ? all(light_.place) : all(light_.place) - positions[0];
  const Mask outside = dot(towards, geometric) > 0;
  for (size_t k = 0; k < 3; ++k) {
    // Normals that are none are those of the facet (facet_of).
    const Vector given = load(corners.normal[k]);
    const Real length2 = norm2(given);
    const Mask usable = (length2 > 0) & (length2 < all(std::numeric_limits<double>::max()));
    normals[k] = choose(usable, given * all(sign_), geometric);
  }

  // meeting() = w . (d x (P - O)), as Pencil::ray has w.
  const Vector d = all(segment_.line.direction), origin = all(segment_.line.origin);
  Mask lit{};
  const auto meeting_at = [&](const Vector& p, const Vector& blend) {
    const Vector n = unit(blend), l = light_.at_infinity ? all(light_.place) : unit(all(light_.place) - p);
    const Real cos_light = dot(l, n), cos2 = 1 - (1 - cos_light * cos_light) * sqr(inverse_eta_);
    const Real cos_refracted = square_root(most(cos2, all(0)));
    const Vector w = n * (cos_light * inverse_eta_ - cos_refracted) - l * all(inverse_eta_);
    lit |= (cos_light > 0) & (cos2 > 0) & (dot(w, geometric) < 0);
    return dot(w, cross(d, p - origin));
  };
  Real corner[3];
  for (size_t k = 0; k < 3; ++k) corner[k] = meeting_at(positions[k], normals[k]);
  const Mask one_sign = ((corner[0] < 0) == (corner[1] < 0)) & ((corner[0] < 0) == (corner[2] < 0));

  // Second differences of meeting() are about theta (size + theta s): theta is the angle by which refracted rays differ
  // over the facet, s their length to the line.
  constexpr double kLeastShare = 0.5, kCaution = 2;
  const Real high = most(most(magnitude(corner[0]), magnitude(corner[1])), magnitude(corner[2]));
  const Real low = least(least(magnitude(corner[0]), magnitude(corner[1])), magnitude(corner[2]));
  const Real size2 = norm2(p_a) + norm2(p_b);
  const Real reach2 = most(norm2(all(segment_.line.at(segment_.from)) - positions[0]),
                           norm2(all(segment_.line.at(segment_.to)) - positions[0]));
  Real theta2 = (norm2(normals[1] - normals[0]) + norm2(normals[2] - normals[0])) / norm2(normals[0]);
  if (!light_.at_infinity) theta2 += size2 / norm2(towards);
  const Mask away = one_sign & (low >= kLeastShare * (high - low)) &
                    (low > kCaution * (square_root(theta2 * size2) + theta2 * square_root(reach2)));
  const Mask left = outside & ~away;
  const uint32_t used = (1u << triangles.size()) - 1;
  if ((bits(left) & used) == 0) return 0;

  const Real sign = corner[0] < 0 ? all(-1) : all(1);
  Mask keeps_its_sign = one_sign;
  for (size_t k = 0; k < 3; ++k) {
    const size_t next = (k + 1) % 3;
    const Real middle = meeting_at((positions[k] + positions[next]) * all(0.5), normals[k] + normals[next]);
    const Real mean = (corner[k] + corner[next]) / 2, side = 2 * middle - mean;
    keeps_its_sign &= sign * side - Quadratic::kShareOfBend * magnitude(side - mean) > 0;
  }
  return bits(left & lit & ~keeps_its_sign) & used;
}

}  // namespace turbid
