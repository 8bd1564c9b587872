#pragma once
#include <algorithm>
#include <span>
#include <vector>

#include "core/vector.h"

namespace turbid {

/// Sources of known strength at known places, drawn in proportion to about what each brings to a point, in time that
/// grows with the logarithm of their number: a tree of boxes with stochastic descent (Estevez & Kulla 2018).
/// Immutable.
class PlaceTree {
 public:
  /// The share of the choice that goes by strength alone: what is expected of a source may be wrong.
  static constexpr float kByStrength = 0.1f;

  PlaceTree() = default;
  /// As many places as strengths (>= 0), in any order.
  PlaceTree(std::span<const Vec3> places, std::span<const float> strengths);

  /// The sources' sum; nothing is drawn where it is 0.
  double strength() const { return nodes_.empty() ? 0 : nodes_.front().strength; }

  /// Draws `count` sources systematically by one uniform number: found(source, expected) for each draw, where
  /// `expected` is how many draws of that source there are on average. Every source with strength can be drawn.
  /// `falloff(d2)` > 0 is about what a source of strength 1 brings over the squared distance d2, and decreases.
  template <class Falloff, class Found>
  void draw(const Vec3& seen, int count, double u, const Falloff& falloff, const Found& found) const {
    if (!(strength() > 0)) return;
    Descent<Falloff, Found> descent{*this, seen, falloff, found, static_cast<double>(count), u, 0};
    descent.visit(0, 1);
  }

 private:
  struct Node {
    Bounds3 box;
    double strength = 0;
    uint32_t second = 0;  ///< of the children, the first follows its parent; 0: a leaf
    uint32_t source = 0;  ///< of leaves
  };

  template <class Falloff, class Found>
  struct Descent {
    const PlaceTree& tree;
    const Vec3& seen;
    const Falloff& falloff;
    const Found& found;
    double count, next, passed;  ///< the next draw, and the expected draws of all that was passed

    /// `near`: the probability of coming here by what is expected of the sources.
    void visit(uint32_t index, double near) {
      const Node& node = tree.nodes_[index];
      const double share = static_cast<double>(kByStrength);
      const double expected = count * ((1 - share) * near + share * node.strength / tree.strength());
      if (passed + expected <= next) {
        passed += expected;
      } else if (node.second == 0) {
        for (passed += expected; next < passed; ++next) found(node.source, expected);
      } else {
        const double first = weight(index + 1), second = weight(node.second), sum = first + second;
        visit(index + 1, sum > 0 ? near * (first / sum) : 0);
        visit(node.second, sum > 0 ? near * (second / sum) : 0);
      }
    }
    double weight(uint32_t index) const {
      const Node& node = tree.nodes_[index];
      float distance2 = 0;
      for (int i = 0; i < 3; ++i) {
        const float beyond = std::max({node.box.min[i] - seen[i], seen[i] - node.box.max[i], 0.0f});
        distance2 += beyond * beyond;
      }
      return node.strength * static_cast<double>(falloff(distance2));
    }
  };

  uint32_t build(std::span<const Vec3> places, std::span<const float> strengths, std::span<uint32_t> range);

  std::vector<Node> nodes_;
};

}  // namespace turbid
