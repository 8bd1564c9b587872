#include "refraction/position_normal_tree.h"

#include <algorithm>
#include <numbers>
#include <numeric>
#include <stdexcept>

namespace turbid {
namespace {

/// Three times the middle of a triangle.
Vec3 middle(const TriangleMesh& mesh, uint32_t triangle) {
  const MeshData& data = mesh.data();
  const uint32_t* i = &data.indices[3 * size_t{triangle}];
  return data.positions[i[0]] + data.positions[i[1]] + data.positions[i[2]];
}

/// Cuts triangles into `parts` of about equal number, each time across the longest axis of their middles.
void cut(const TriangleMesh& mesh, std::span<uint32_t> triangles, size_t parts,
         std::vector<std::span<uint32_t>>& result) {
  if (parts <= 1) return result.push_back(triangles);
  Bounds3 box;
  for (const uint32_t triangle : triangles) box.extendBy(middle(mesh, triangle));
  const int axis = static_cast<int>(box.majorAxis());
  const size_t first_parts = parts / 2, first = triangles.size() * first_parts / parts;
  std::nth_element(triangles.begin(), triangles.begin() + static_cast<std::ptrdiff_t>(first), triangles.end(),
                   [&](uint32_t x, uint32_t y) {
                     const float mx = middle(mesh, x)[axis], my = middle(mesh, y)[axis];
                     return mx < my || (mx == my && x < y);
                   });
  cut(mesh, triangles.first(first), first_parts, result);
  cut(mesh, triangles.subspan(first), parts - first_parts, result);
}

}  // namespace

PositionNormalTree::PositionNormalTree(const TriangleMesh& mesh) : triangles_(mesh.triangle_count()) {
  std::iota(triangles_.begin(), triangles_.end(), 0u);
  if (!triangles_.empty()) build(mesh, triangles_, 0);
  nodes_.shrink_to_fit();
}

void PositionNormalTree::build(const TriangleMesh& mesh, std::span<uint32_t> triangles, uint32_t first) {
  constexpr size_t kLanes = BoundedNormals::kLanes;
  size_t below = kLeafSize;  // triangles that a child can hold
  while (below * kLanes < triangles.size()) below *= kLanes;
  std::vector<std::span<uint32_t>> parts;
  cut(mesh, triangles, (triangles.size() + below - 1) / below, parts);
  const size_t index = nodes_.size();
  nodes_.push_back({});
  nodes_[index].lanes = (1u << parts.size()) - 1;
  for (size_t k = 0; k < parts.size(); ++k) {
    bound(mesh, parts[k], nodes_[index].bounds, k);
    const bool leaf = parts[k].size() <= kLeafSize;
    nodes_[index].begin[k] = leaf ? first : static_cast<uint32_t>(nodes_.size());
    nodes_[index].count[k] = static_cast<uint8_t>(leaf ? parts[k].size() : 0);
    if (!leaf) build(mesh, parts[k], first);
    first += static_cast<uint32_t>(parts[k].size());
  }
}

void PositionNormalTree::bound(const TriangleMesh& mesh, std::span<const uint32_t> triangles, BoundedNormals& bounds,
                               size_t lane) {
  const MeshData& data = mesh.data();
  Bounds3 box;
  V3d sum(0);
  const auto for_corners = [&](const auto& see) {
    for (const uint32_t triangle : triangles) {
      const Facet facet = facet_of(mesh, triangle);
      for (size_t k = 0; k < 3; ++k) {
        const V2d at(k == 1, k == 2);
        see(data.positions[data.indices[3 * size_t{triangle} + k]], facet.normal(at));
      }
    }
  };
  for_corners([&](const Vec3& p, const V3d& n) {
    box.extendBy(p);
    sum += n;
  });
  const Vec3 center = box.center(), axis = sum.length() > 0 ? Vec3(sum.normalized()) : Vec3(0, 0, 1);
  double radius2 = 0, least_cosine = 1;
  for_corners([&](const Vec3& p, const V3d& n) {
    radius2 = std::max(radius2, (V3d(p) - V3d(center)).length2());
    least_cosine = std::min(least_cosine, n.dot(V3d(axis)));
  });
  for (int k = 0; k < 3; ++k) {
    bounds.center[k][lane] = center[k];
    bounds.axis[k][lane] = axis[k];
  }
  constexpr double kSlack = 1e-6;  // for the rounding to float
  bounds.radius[lane] = static_cast<float>(std::sqrt(radius2) * (1 + kSlack));
  // A blend of normals stays in their cone as long as that is convex; the cosine of a small angle is inexact.
  bounds.angle[lane] =
      static_cast<float>(least_cosine > 0 ? std::acos(std::max(least_cosine - 1e-7, 0.0)) + kSlack : std::numbers::pi);
}

void PositionNormalTree::validate(const TriangleMesh& mesh) const {
  const auto check = [](bool good) {
    if (!good) throw std::logic_error("a node of the position-normal tree does not hold what is below it");
  };
  std::vector<uint32_t> seen = triangles_;
  std::sort(seen.begin(), seen.end());
  for (size_t i = 0; i < seen.size(); ++i) check(seen[i] == i);
  check(triangles_.size() == mesh.triangle_count());
  const auto check_lane = [&](const BoundedNormals& bounds, size_t k, uint32_t triangle) {
    const auto row = [k](const float lanes[3][BoundedNormals::kLanes]) {
      return V3d(Vec3(lanes[0][k], lanes[1][k], lanes[2][k]));
    };
    const Facet facet = facet_of(mesh, triangle);
    for (const V2d& at : {V2d(0, 0), V2d(1, 0), V2d(0, 1)}) {
      check((facet.position(at) - row(bounds.center)).length() <= static_cast<double>(bounds.radius[k]));
      const double cosine = facet.normal(at).dot(row(bounds.axis));
      check(std::acos(std::clamp(cosine, -1.0, 1.0)) <= static_cast<double>(bounds.angle[k]));
    }
  };
  // Returns one past the last triangle, given the first.
  const auto holds = [&](const auto& self, uint32_t index, uint32_t first) -> uint32_t {
    const Node& node = nodes_.at(index);
    for (size_t k = 0; node.lanes >> k != 0; ++k) {
      uint32_t last = node.begin[k] + node.count[k];
      if (node.count[k] > 0)
        check(node.begin[k] == first);
      else
        last = self(self, node.begin[k], first);
      for (uint32_t i = first; i < last; ++i) check_lane(node.bounds, k, triangles_[i]);
      first = last;
    }
    return first;
  };
  if (!nodes_.empty()) check(holds(holds, 0, 0) == triangles_.size());
}

}  // namespace turbid
