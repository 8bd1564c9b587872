#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

namespace turbid {

/// Ascending numbers that begin with 0 and cut a range into intervals, and the search for the interval of a number.
///
/// The bits of non-negative floats are ordered as the floats are. The exponent and the upper bits of the mantissa so
/// number cells that are finer towards 0, as the nodes here are; a guide keeps where each cell begins, and few steps of
/// bisection remain.
class NodeIndex {
 public:
  NodeIndex() = default;
  /// At least two finite numbers, the first one 0, none below the one before it; else std::invalid_argument.
  explicit NodeIndex(std::vector<float> nodes);

  size_t size() const { return nodes_.size(); }
  float operator[](size_t i) const { return nodes_[i]; }
  const std::vector<float>& nodes() const { return nodes_; }

  /// The last i with node i <= x, but not the last node: the interval [i, i + 1] is that of x. Takes x >= 0; beyond the
  /// last node it is the last interval.
  size_t interval(float x) const;

 private:
  size_t cell(float x) const;

  std::vector<float> nodes_;
  uint32_t first_cell_ = 0;
  std::vector<uint32_t> guide_;  ///< interval where a cell begins; one more entry than cells
};

}  // namespace turbid
