#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "refraction/contour.h"

namespace turbid {

/// A hierarchy of the triangles of one mesh for refraction: each node knows a ball around its triangles and a cone
/// around their shading normals. From both follows a cone that all light of one point is refracted into, and from that
/// the part of a segment that such light can meet (S4 sect. 3.2.4 asks for cones that can contain the half-vector;
/// going with the light keeps the segment out of it until the end).
///
/// Built deterministically, by halves along the longest axis; at most kMaxBytesPerTriangle.
class PositionNormalTree {
 public:
  static constexpr size_t kMaxBytesPerTriangle = 64;

  explicit PositionNormalTree(const TriangleMesh& mesh);

  /// What of a segment the light can reach that a node refracts; empty: nothing.
  using Interval = std::optional<std::pair<double, double>>;

  /// Calls visit(triangle, from, to) for all triangles whose refracted light may meet the segment within [from, to],
  /// in a fixed order. `flipped`: the light stands on the inside.
  template <class Visit>
  void visit(const LightPoint& light, double eta, bool flipped, const Segment& segment, const Visit& visitor) const {
    if (!nodes_.empty()) descend(0, Query(light, eta, flipped), segment, segment.from, segment.to, visitor);
  }

  /// Throws std::logic_error where a node does not hold what is below it.
  void validate(const TriangleMesh& mesh) const;

  size_t bytes() const {
    return nodes_.capacity() * sizeof(Node) + triangles_.capacity() * sizeof(uint32_t) + sizeof(*this);
  }
  size_t triangle_count() const { return triangles_.size(); }

 private:
  struct Node {
    Vec3 center;
    float radius;
    Vec3 axis;              ///< of the cone of normals, on the outside, unit
    float angle;            ///< half opening of the cone, radians; pi: no bound
    uint32_t begin, count;  ///< leaves: triangles; others: the second child, and 0 (the first one comes next)
  };
  static_assert(sizeof(Node) == 40);

  struct Query {
    Query(const LightPoint& light_point, double index_ratio, bool light_inside);
    LightPoint light;
    double eta, inverse_eta;
    double sign;                          ///< of normals: -1 where the light stands on the inside
    double cos_deviation, sin_deviation;  ///< of the angle by which refraction bends light at most
  };

  static constexpr uint32_t kLeafSize = 3;

  void build(const TriangleMesh& mesh, std::span<uint32_t> triangles, uint32_t first);
  static Node bound(const TriangleMesh& mesh, std::span<const uint32_t> triangles);
  static Interval reach(const Node& node, const Query& query, const Line& line, double from, double to);

  template <class Visit>
  void descend(uint32_t index, const Query& query, const Segment& segment, double from, double to,
               const Visit& visitor) const {
    const Node& node = nodes_[index];
    const Interval part = reach(node, query, segment.line, from, to);
    if (!part) return;
    if (node.count > 0) {
      for (uint32_t i = node.begin; i < node.begin + node.count; ++i) visitor(triangles_[i], part->first, part->second);
      return;
    }
    descend(index + 1, query, segment, part->first, part->second, visitor);
    descend(node.begin, query, segment, part->first, part->second, visitor);
  }

  std::vector<Node> nodes_;
  std::vector<uint32_t> triangles_;
};

}  // namespace turbid
