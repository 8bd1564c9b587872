#pragma once
#include <bit>
#include <span>
#include <vector>

#include "refraction/refracted_reach.h"

namespace turbid {

/// A hierarchy of the triangles of one mesh for refraction: a node knows, of each of up to eight children, a ball
/// around their triangles and a cone around their shading normals, and asks for the reach of all of them at once.
///
/// Built deterministically, by cuts across the longest axis; at most kMaxBytesPerTriangle.
class PositionNormalTree {
 public:
  static constexpr size_t kMaxBytesPerTriangle = 64;

  explicit PositionNormalTree(const TriangleMesh& mesh);

  /// Calls visit(triangle, from, to) for all triangles whose refracted light may meet the segment within [from, to],
  /// in a fixed order. `flipped`: the light stands on the inside.
  template <class Visit>
  void visit(const LightPoint& light, double eta, bool flipped, const Segment& segment, const Visit& visitor) const {
    if (!nodes_.empty())
      descend(0, RefractionQuery(light, eta, flipped), segment.line, segment.from, segment.to, visitor);
  }

  /// Throws std::logic_error where a node does not hold what is below it.
  void validate(const TriangleMesh& mesh) const;

  size_t bytes() const {
    return nodes_.capacity() * sizeof(Node) + triangles_.capacity() * sizeof(uint32_t) + sizeof(*this);
  }
  size_t triangle_count() const { return triangles_.size(); }

 private:
  struct Node {
    BoundedNormals bounds;
    uint32_t begin[BoundedNormals::kLanes];  ///< leaves: of their triangles; others: their node
    uint8_t count[BoundedNormals::kLanes];   ///< triangles of a leaf; 0: no leaf
    uint32_t lanes;                          ///< that are in use, a bit for each
  };

  static constexpr uint32_t kLeafSize = 4;

  void build(const TriangleMesh& mesh, std::span<uint32_t> triangles, uint32_t first);
  static void bound(const TriangleMesh& mesh, std::span<const uint32_t> triangles, BoundedNormals& bounds, size_t lane);

  template <class Visit>
  void descend(uint32_t index, const RefractionQuery& query, const Line& line, double from, double to,
               const Visit& visitor) const {
    const Node& node = nodes_[index];
    const RefractedReach reach = refracted_reach(node.bounds, query, line, from, to);
    for (uint32_t lanes = reach.lanes & node.lanes; lanes != 0; lanes &= lanes - 1) {
      const auto k = static_cast<size_t>(std::countr_zero(lanes));
      const uint32_t begin = node.begin[k];
      if (node.count[k] == 0) descend(begin, query, line, reach.from[k], reach.to[k], visitor);
      for (uint32_t i = begin; i < begin + node.count[k]; ++i) visitor(triangles_[i], reach.from[k], reach.to[k]);
    }
  }

  std::vector<Node> nodes_;
  std::vector<uint32_t> triangles_;
};

}  // namespace turbid
