#include "geometry/triangle_mesh.h"

#include <fmt/format.h>

#include <bit>
#include <stdexcept>

#include "core/log.h"
#include "core/rng.h"
#include "core/warp.h"
#include "geometry/mesh_topology.h"
#include "geometry/shading_frame.h"

namespace turbid {
namespace {
using Imath::V3d;

/// Embree's ray-triangle arithmetic loses its range beyond this.
constexpr float kLargestCoordinate = 1e18f;

[[noreturn]] void refuse(const MeshData& mesh, const std::string& why) {
  throw std::invalid_argument(fmt::format("mesh '{}': {}", mesh.name, why));
}

void validate(const MeshData& mesh) {
  const size_t n = mesh.positions.size();
  if (n >= (size_t{1} << 31)) refuse(mesh, fmt::format("{} vertices are more than 2^31 - 1", n));
  if (mesh.indices.size() % 3 != 0) refuse(mesh, "the number of indices is not a multiple of 3");
  if (mesh.triangle_count() >= (size_t{1} << 32) - 1)
    refuse(mesh, fmt::format("{} triangles are too many", mesh.triangle_count()));
  if (!mesh.normals.empty() && mesh.normals.size() != n)
    refuse(mesh, fmt::format("{} vertex normals for {} vertices", mesh.normals.size(), n));
  if (!mesh.uvs.empty() && mesh.uvs.size() != n)
    refuse(mesh, fmt::format("{} texture coordinates for {} vertices", mesh.uvs.size(), n));
  for (size_t i = 0; i < n; ++i) {
    const Vec3& p = mesh.positions[i];
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
      refuse(mesh, fmt::format("the position of vertex {} is not finite: ({}, {}, {})", i, p.x, p.y, p.z));
    if (max_component(abs(p)) > kLargestCoordinate)
      refuse(mesh,
             fmt::format("the position of vertex {} is beyond {}: ({}, {}, {})", i, kLargestCoordinate, p.x, p.y, p.z));
  }
  for (size_t i = 0; i < mesh.indices.size(); ++i)
    if (mesh.indices[i] >= n)
      refuse(mesh, fmt::format("triangle {} refers to vertex {}, but there are {}", i / 3, mesh.indices[i], n));
  for (const MeshAttribute& a : mesh.attributes) {
    const size_t expected = static_cast<size_t>(a.channels) * (a.per_face ? mesh.triangle_count() : n);
    if ((a.channels != 1 && a.channels != 3) || a.values.size() != expected)
      refuse(mesh, fmt::format("attribute '{}' has {} values of {} channels, expected {}", a.name, a.values.size(),
                               a.channels, expected));
  }
}

/// Twice the triangle's area times its normal; double, so that only really degenerate triangles give zero.
V3d area_normal(const MeshData& mesh, size_t triangle) {
  const uint32_t* i = &mesh.indices[3 * triangle];
  const V3d a(mesh.positions[i[0]]), b(mesh.positions[i[1]]), c(mesh.positions[i[2]]);
  return (b - a).cross(c - a);
}

bool usable(const Vec3& n) { return std::isfinite(n.x + n.y + n.z) && length_squared(n) > 0; }
}  // namespace

TriangleMesh::TriangleMesh(MeshData data, bool flip_normals) : mesh_(std::move(data)) {
  validate(mesh_);
  drop_degenerate_triangles();
  settle_orientation();
  if (flip_normals) flip_mesh(mesh_);
  for (const uint32_t i : mesh_.indices) bounds_.extendBy(mesh_.positions[i]);
  edge_slack_ = find_edge_slack();
  // Embree reads 16 bytes of the last vertex too.
  mesh_.positions.reserve(mesh_.positions.size() + 1);
}

void TriangleMesh::drop_degenerate_triangles() {
  const size_t count = triangle_count();
  std::vector<uint32_t> kept_faces;
  size_t kept = 0;
  for (size_t t = 0; t < count; ++t) {
    const double twice_area = area_normal(mesh_, t).length();
    if (!(twice_area > 0)) {
      if (kept == t) {  // the first one: from here on faces move
        kept_faces.reserve(count);
        for (size_t f = 0; f < t; ++f) kept_faces.push_back(static_cast<uint32_t>(f));
      }
      continue;
    }
    area_ += twice_area / 2;
    if (kept != t) {
      kept_faces.push_back(static_cast<uint32_t>(t));
      for (size_t k = 0; k < 3; ++k) mesh_.indices[3 * kept + k] = mesh_.indices[3 * t + k];
    }
    ++kept;
  }
  if (kept == 0) refuse(mesh_, count == 0 ? "there are no triangles" : "all triangles are degenerate (without area)");
  if (kept == count) return;
  mesh_.indices.resize(3 * kept);
  for (MeshAttribute& a : mesh_.attributes) {
    if (!a.per_face) continue;
    const auto channels = static_cast<size_t>(a.channels);
    for (size_t f = 0; f < kept; ++f)
      for (size_t c = 0; c < channels; ++c) a.values[f * channels + c] = a.values[kept_faces[f] * channels + c];
    a.values.resize(kept * channels);
  }
  log_warning(
      fmt::format("mesh '{}': dropped {} of {} triangles, which have no area", mesh_.name, count - kept, count));
}

void TriangleMesh::settle_orientation() {
  if (mesh_.normals.empty()) return;
  double agreeing = 0, opposing = 0, six_volumes = 0;
  for (size_t t = 0; t < triangle_count(); ++t) {
    const V3d n = area_normal(mesh_, t);
    const uint32_t* i = &mesh_.indices[3 * t];
    const Vec3 shading = mesh_.normals[i[0]] + mesh_.normals[i[1]] + mesh_.normals[i[2]];
    const double side = n.dot(V3d(shading));
    if (side > 0) agreeing += n.length();
    if (side < 0) opposing += n.length();
    six_volumes += n.dot(V3d(mesh_.positions[i[0]]) - V3d(mesh_.positions[0]));
  }
  if (!(opposing > agreeing)) return;
  if (!is_closed()) {
    log_warning(
        fmt::format("mesh '{}': its vertex normals point to the other side than the order of its corners says; "
                    "the normals are followed",
                    mesh_.name));
    for (size_t i = 0; i < mesh_.indices.size(); i += 3) std::swap(mesh_.indices[i + 1], mesh_.indices[i + 2]);
    return;
  }
  log_warning(
      fmt::format("mesh '{}': its vertex normals point to the other side than the order of its corners says; it is "
                  "closed, so the outside is taken as outside",
                  mesh_.name));
  if (six_volumes < 0)
    for (size_t i = 0; i < mesh_.indices.size(); i += 3) std::swap(mesh_.indices[i + 1], mesh_.indices[i + 2]);
  else
    for (Vec3& n : mesh_.normals) n = -n;
}

float TriangleMesh::find_edge_slack() const {
  constexpr float kEdgeRoundings = 4;
  float squared = 0;
  for (size_t i = 0; i < mesh_.indices.size(); i += 3)
    for (size_t k = 0; k < 3; ++k)
      squared = std::max(squared, length_squared(mesh_.positions[mesh_.indices[i + (k + 1) % 3]] -
                                                 mesh_.positions[mesh_.indices[i + k]]));
  // Beyond the range of squares in float the coordinates themselves bound it.
  const float longest = std::isfinite(squared) ? std::sqrt(squared) : 4 * kLargestCoordinate;
  return kEdgeRoundings * kUnitRoundoff * longest;
}

bool TriangleMesh::is_closed() const {
  std::call_once(closed_once_, [&] { closed_ = edges_are_paired(mesh_); });
  return closed_;
}

const MeshAttribute* TriangleMesh::attribute(const std::string& name) const {
  for (const MeshAttribute& a : mesh_.attributes)
    if (a.name == name) return &a;
  return nullptr;
}

Vec3 TriangleMesh::eval_attribute(const MeshAttribute& attribute, const SurfacePoint& at) const {
  const auto channels = static_cast<size_t>(attribute.channels);
  const auto value = [&](size_t index, size_t c) {
    return attribute.values[index * channels + (channels == 1 ? 0 : c)];
  };
  const uint32_t* i = &mesh_.indices[3 * size_t{at.primitive}];
  const float b1 = at.barycentric.x, b2 = at.barycentric.y, b0 = 1 - b1 - b2;
  Vec3 result;
  for (size_t c = 0; c < 3; ++c) {
    const float v =
        attribute.per_face ? value(at.primitive, c) : b0 * value(i[0], c) + b1 * value(i[1], c) + b2 * value(i[2], c);
    result[static_cast<int>(c)] = v;
  }
  return result;
}

SurfacePoint TriangleMesh::point_on_triangle(uint32_t triangle, const Vec2& barycentric, float extra_error) const {
  const uint32_t* i = &mesh_.indices[3 * size_t{triangle}];
  const Vec3 v0 = mesh_.positions[i[0]], v1 = mesh_.positions[i[1]], v2 = mesh_.positions[i[2]];
  // In double and rounded once: what remains is the rounding of the position to float.
  const V3d origin(v0), edge1 = V3d(v1) - origin, edge2 = V3d(v2) - origin;
  const V3d n = edge1.cross(edge2);
  const double twice_area = n.length();

  // A ray cast decides on which side of the triangle it starts by dot(v0 - origin, Ng) / |Ng| in float. The rounding of
  // that is a few units in the last place of |v0 - origin|, times 1 plus the relative error of the cross product Ng,
  // which Embree takes of two edges of which one is the shortest: large only for triangles with three nearly parallel
  // edges. Starting further away than this keeps it right; edge_slack_ keeps it off the widened neighbours too.
  constexpr float kCastRoundings = 6;
  const Vec3 e1(v1 - v0), e2(v2 - v0);
  const float squared1 = length_squared(e1), squared2 = length_squared(e2), squared3 = length_squared(e2 - e1);
  const float longest_squared = std::max({squared1, squared2, squared3});
  const float area = static_cast<float>(twice_area);
  const float slenderness = std::sqrt(longest_squared * std::min({squared1, squared2, squared3})) / area;
  const Vec3 from_v0 = abs(e1 * barycentric.x + e2 * barycentric.y);
  const float cast_error = kCastRoundings * kUnitRoundoff * (1 + slenderness) * (from_v0.x + from_v0.y + from_v0.z);
  const Vec3 extent(std::max({std::abs(v0.x), std::abs(v1.x), std::abs(v2.x)}),
                    std::max({std::abs(v0.y), std::abs(v1.y), std::abs(v2.y)}),
                    std::max({std::abs(v0.z), std::abs(v1.z), std::abs(v2.z)}));

  SurfacePoint s;
  s.error = rounding_error(extent) + cast_error + edge_slack_ + extra_error;

  // A point nearer to an edge than a few errors could be moved, by its own rounding or by leave(), beyond the
  // neighbouring triangle. It is taken back into this one: at a distance of k errors from its edges it stays on the
  // right side of all neighbours that meet this triangle at more than atan(1/k). The height over an edge is at least
  // twice_area / longest.
  constexpr float kEdgeErrors = 8, kLargestMargin = 0.25f;
  const float margin = std::min(kEdgeErrors * s.error * std::sqrt(longest_squared) / area, kLargestMargin);
  Vec2 b = barycentric;
  if (std::min({b.x, b.y, 1 - b.x - b.y}) < margin) b = Vec2(margin) + b * (1 - 3 * margin);

  const V3d exact = origin + edge1 * static_cast<double>(b.x) + edge2 * static_cast<double>(b.y);
  s.mesh = this;
  s.primitive = triangle;
  s.barycentric = b;
  s.p = Vec3(exact);
  s.ng = Vec3(n * (1 / twice_area));

  s.uv = b;
  const Frame fallback(s.ng);
  s.dp_du = fallback.s;
  s.dp_dv = fallback.t;
  if (has_uvs()) {
    const Vec2 uv0 = mesh_.uvs[i[0]], d1 = mesh_.uvs[i[1]] - uv0, d2 = mesh_.uvs[i[2]] - uv0;
    s.uv = uv0 + d1 * b.x + d2 * b.y;
    const float determinant = d1.x * d2.y - d1.y * d2.x;
    const float inverse = 1 / determinant;
    if (determinant != 0 && std::isfinite(inverse)) {
      s.dp_du = (e1 * d2.y - e2 * d1.y) * inverse;
      s.dp_dv = (e2 * d1.x - e1 * d2.x) * inverse;
    }
  }
  Vec3 shading = s.ng;
  if (has_vertex_normals()) {
    const float b0 = 1 - b.x - b.y;
    const Vec3 &n0 = mesh_.normals[i[0]], &n1 = mesh_.normals[i[1]], &n2 = mesh_.normals[i[2]];
    const Vec3 blend = (usable(n0) ? n0 : s.ng) * b0 + (usable(n1) ? n1 : s.ng) * b.x + (usable(n2) ? n2 : s.ng) * b.y;
    shading = bend_to_front(blend, s.ng);
  }
  s.shading = shading_frame(shading, s.dp_du);
  return s;
}

SurfacePoint TriangleMesh::surface_point(const Ray&, const Hit& hit) const {
  return point_on_triangle(hit.primitive, hit.barycentric);
}

AreaSample TriangleMesh::sample_area(const Vec2& u) const {
  std::call_once(areas_once_, [&] {
    std::vector<float> areas(triangle_count());
    // Relative areas: their squares must not leave the range of float for tiny or huge meshes.
    for (size_t t = 0; t < areas.size(); ++t)
      areas[t] = static_cast<float>(area_normal(mesh_, t).length() / (2 * area_));
    triangle_areas_ = DiscreteDistribution(areas);
  });
  const DiscreteSample triangle = triangle_areas_.sample(u.x);
  const Vec2 b = square_to_triangle({triangle.u, u.y});
  return {point_on_triangle(static_cast<uint32_t>(triangle.index), b), 1 / area()};
}

RTCGeometry TriangleMesh::make_embree_geometry(RTCDevice device) const {
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, mesh_.positions.data(), 0,
                             sizeof(Vec3), mesh_.positions.size());
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, mesh_.indices.data(), 0,
                             3 * sizeof(uint32_t), triangle_count());
  rtcCommitGeometry(geometry);
  return geometry;
}

float TriangleMesh::distance_bound(const Vec3& p, uint32_t primitive) const {
  const uint32_t* i = &mesh_.indices[3 * size_t{primitive}];
  const V3d point(p);
  return static_cast<float>(distance_to_triangle(V3d(mesh_.positions[i[0]]) - point, V3d(mesh_.positions[i[1]]) - point,
                                                 V3d(mesh_.positions[i[2]]) - point) *
                            (1 - 1e-7));  // the rounding to float must not raise it
}

}  // namespace turbid
