#pragma once
#include <array>
#include <span>
#include <vector>

#include "table/quadtree.h"

namespace turbid {

/// Where a field that lives in a quadtree is looked up at a place that it holds: at the middles of four cells of the
/// size of that at the place, in whatever leaves they lie. Beyond the tree's edge its cells go on.
struct QuadtreeCorners {
  std::array<size_t, 4> leaves;
  std::array<float, 4> weights;  ///< bilinear
  std::array<bool, 4> beyond;    ///< the source's axis, where the sagittal plane points the other way

  QuadtreeCorners(const Quadtree& tree, const Quadtree::Place& place);
};

/// What the interpolant of values in a quadtree's leaves puts into each leaf: int dV, a linear function of the values.
class QuadtreeContent {
 public:
  explicit QuadtreeContent(const Quadtree& tree);

  std::vector<double> of(std::span<const double> values) const;
  /// A field: its values in each leaf, and the factor by which the interpolant is multiplied within each leaf.
  struct Field {
    std::vector<double> values, factors;
  };
  /// That has these contents, which must not be negative. Values are sharpened until the interpolant almost has them,
  /// within 0.3 and 3 times each leaf's mean; factors do the rest, where light falls off so steeply that a leaf's
  /// neighbours alone put more into it than there is.
  Field to_field(std::span<const double> contents) const;

 private:
  struct Share {
    size_t leaf;
    double volume;
  };
  std::vector<std::vector<Share>> rows_;  ///< per leaf: who puts something into it, and how much per value
  std::vector<double> volumes_;
};

}  // namespace turbid
