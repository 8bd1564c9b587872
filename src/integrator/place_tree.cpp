#include "integrator/place_tree.h"

#include <numeric>

namespace turbid {

PlaceTree::PlaceTree(std::span<const Vec3> places, std::span<const float> strengths) {
  std::vector<uint32_t> order(places.size());
  std::iota(order.begin(), order.end(), 0u);
  if (order.empty()) return;
  nodes_.reserve(2 * order.size() - 1);
  build(places, strengths, order);
}

uint32_t PlaceTree::build(std::span<const Vec3> places, std::span<const float> strengths, std::span<uint32_t> range) {
  const auto index = static_cast<uint32_t>(nodes_.size());
  nodes_.emplace_back();
  Bounds3 box;
  double sum = 0;
  for (const uint32_t i : range) {
    box.extendBy(places[i]);
    sum += static_cast<double>(strengths[i]);
  }
  nodes_[index] = {box, sum, 0, range.front()};
  if (range.size() == 1) return index;
  const int axis = static_cast<int>(box.majorAxis());
  const auto middle = range.begin() + static_cast<std::ptrdiff_t>(range.size() / 2);
  std::nth_element(range.begin(), middle, range.end(), [&](uint32_t a, uint32_t b) {
    return std::pair(places[a][axis], a) < std::pair(places[b][axis], b);
  });
  build(places, strengths, range.first(range.size() / 2));
  nodes_[index].second = build(places, strengths, range.subspan(range.size() / 2));
  return index;
}

}  // namespace turbid
