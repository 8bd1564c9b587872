#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <numeric>
#include <span>
#include <vector>

namespace turbid {

/// Orders the range so that its first half lies before the rest along the axis where it is widest; returns the axis.
template <size_t D>
size_t halve(const std::vector<std::array<float, D>>& points, std::span<uint32_t> range) {
  std::array<float, D> low = points[range.front()], high = low;
  for (const uint32_t i : range)
    for (size_t d = 0; d < D; ++d) {
      low[d] = std::min(low[d], points[i][d]);
      high[d] = std::max(high[d], points[i][d]);
    }
  size_t axis = 0;
  for (size_t d = 1; d < D; ++d)
    if (high[d] - low[d] > high[axis] - low[axis]) axis = d;
  const auto middle = range.begin() + static_cast<std::ptrdiff_t>(range.size() / 2);
  std::nth_element(range.begin(), middle, range.end(), [&](uint32_t a, uint32_t b) {
    return points[a][axis] != points[b][axis] ? points[a][axis] < points[b][axis] : a < b;
  });
  return axis;
}

/// Cuts the range into groups of at most `most` points that lie together, and calls visit(group) for each.
template <size_t D, class Visit>
void for_groups(const std::vector<std::array<float, D>>& points, std::span<uint32_t> range, size_t most,
                const Visit& visit) {
  if (range.empty()) return;
  if (range.size() <= std::max<size_t>(most, 1)) return visit(range);
  halve(points, range);
  const size_t half = range.size() / 2;
  for_groups(points, range.subspan(0, half), most, visit);
  for_groups(points, range.subspan(half), most, visit);
}

/// Finds the points nearest to a place, in D dimensions. Built once; queries are const and thread-safe.
template <size_t D>
class KdTree {
 public:
  using Point = std::array<float, D>;
  struct Neighbour {
    uint32_t index = 0;  ///< of the point as it was given
    float distance2 = std::numeric_limits<float>::infinity();
  };

  KdTree() = default;
  explicit KdTree(std::vector<Point> points) : points_(std::move(points)), order_(points_.size()) {
    std::iota(order_.begin(), order_.end(), 0u);
    axes_.resize(points_.size());
    build(0, points_.size());
    // In the tree's order, so that neighbours share lines of memory.
    std::vector<Point> ordered;
    ordered.reserve(points_.size());
    for (const uint32_t i : order_) ordered.push_back(points_[i]);
    points_ = std::move(ordered);
  }

  size_t size() const { return points_.size(); }

  /// Fills `found` with the nearest points, nearest first, and returns how many there are (fewer than asked for only
  /// where the tree has fewer). Points at equal distance are taken in an order that depends on the tree alone.
  size_t nearest(const Point& place, std::span<Neighbour> found) const {
    size_t count = 0;
    search(place, 0, points_.size(), found, count);
    return count;
  }

 private:
  static constexpr size_t kLeaf = 8;  ///< points that are asked one by one

  // The middle of a range is its node; what lies before it along the node's axis stands before it.
  void build(size_t begin, size_t end) {
    if (end - begin <= kLeaf) return;
    const size_t middle = (begin + end) / 2;
    axes_[middle] = static_cast<uint8_t>(halve(points_, std::span(order_).subspan(begin, end - begin)));
    build(begin, middle);
    build(middle + 1, end);
  }

  void search(const Point& place, size_t begin, size_t end, std::span<Neighbour> found, size_t& count) const {
    if (found.empty()) return;
    if (end - begin <= kLeaf) {
      for (size_t i = begin; i < end; ++i) insert({order_[i], distance2_to(place, i)}, found, count);
      return;
    }
    const size_t middle = (begin + end) / 2;
    const Point& node = points_[middle];
    const size_t axis = axes_[middle];
    const float beyond = place[axis] - node[axis];
    const bool first_half = beyond < 0;
    first_half ? search(place, begin, middle, found, count) : search(place, middle + 1, end, found, count);
    insert({order_[middle], distance2_to(place, middle)}, found, count);
    if (count < found.size() || beyond * beyond < found[count - 1].distance2)
      first_half ? search(place, middle + 1, end, found, count) : search(place, begin, middle, found, count);
  }

  float distance2_to(const Point& place, size_t i) const {
    float distance2 = 0;
    for (size_t d = 0; d < D; ++d) distance2 += (place[d] - points_[i][d]) * (place[d] - points_[i][d]);
    return distance2;
  }

  static void insert(const Neighbour& neighbour, std::span<Neighbour> found, size_t& count) {
    if (count == found.size() && neighbour.distance2 >= found[count - 1].distance2) return;
    size_t i = count < found.size() ? count++ : count - 1;
    for (; i > 0 && found[i - 1].distance2 > neighbour.distance2; --i) found[i] = found[i - 1];
    found[i] = neighbour;
  }

  std::vector<Point> points_;
  std::vector<uint32_t> order_;
  std::vector<uint8_t> axes_;
};

}  // namespace turbid
