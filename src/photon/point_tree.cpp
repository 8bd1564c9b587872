#include "photon/point_tree.h"

#include <tbb/parallel_invoke.h>

#include <bit>
#include <tuple>

namespace turbid {

void PointTree::build(std::span<const Vec3> points) {
  items_.resize(points.size());
  for (size_t i = 0; i < points.size(); ++i) items_[i] = {points[i], static_cast<uint32_t>(i)};
  // As many levels as halving takes until every part is a leaf.
  const size_t leaves = (points.size() + kLeaf - 1) / kLeaf;
  nodes_.assign(leaves > 1 ? std::bit_ceil(leaves) * 2 : 0, {});
  if (!nodes_.empty()) split(0, 0, items_.size());
}

void PointTree::split(size_t node, size_t from, size_t to) {
  if (to - from <= kLeaf) return;
  Bounds3 box;
  for (size_t i = from; i < to; ++i) box.extendBy(items_[i].position);
  const int axis = static_cast<int>(box.majorAxis());
  const size_t mid = middle(from, to);
  const auto at = [&](size_t i) { return items_.begin() + static_cast<std::ptrdiff_t>(i); };
  std::nth_element(at(from), at(mid), at(to), [axis](const Item& a, const Item& b) {
    return std::tuple(a.position[axis], a.number) < std::tuple(b.position[axis], b.number);
  });
  nodes_[node] = {items_[mid].position[axis], axis};
  const auto lower = [&] { split(2 * node + 1, from, mid); };
  const auto upper = [&] { split(2 * node + 2, mid, to); };
  if (to - from > kParallel) {
    tbb::parallel_invoke(lower, upper);
  } else {
    lower();
    upper();
  }
}

}  // namespace turbid
