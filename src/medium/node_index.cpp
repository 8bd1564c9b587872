#include "medium/node_index.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <stdexcept>

namespace turbid {
namespace {

constexpr uint32_t kShift = 13;        // leaves 10 bits of the mantissa: 1024 cells per octave
constexpr float kSmallest = 0x1p-22f;  // of the last node: below that all is one cell

uint32_t raw_cell(float x) { return std::bit_cast<uint32_t>(x) >> kShift; }

}  // namespace

NodeIndex::NodeIndex(std::vector<float> nodes) : nodes_(std::move(nodes)) {
  if (nodes_.size() < 2 || nodes_.front() != 0 || !std::isfinite(nodes_.back()) || !(nodes_.back() > 0) ||
      !std::is_sorted(nodes_.begin(), nodes_.end()))
    throw std::invalid_argument("the nodes of a table must ascend from 0");

  const float smallest = std::max(*std::upper_bound(nodes_.begin(), nodes_.end(), 0.0f), nodes_.back() * kSmallest);
  first_cell_ = raw_cell(smallest);
  const size_t cells = raw_cell(nodes_.back()) - first_cell_ + 1;
  const auto last = static_cast<uint32_t>(nodes_.size() - 2);
  guide_.assign(cells + 1, last);
  guide_[0] = 0;
  for (size_t i = 1; i < cells; ++i) {
    const float begin = std::bit_cast<float>((first_cell_ + static_cast<uint32_t>(i)) << kShift);
    const auto above = std::upper_bound(nodes_.begin(), nodes_.end(), begin);
    guide_[i] = std::min(static_cast<uint32_t>(above - nodes_.begin()) - 1, last);
  }
}

size_t NodeIndex::cell(float x) const {
  const uint32_t raw = raw_cell(x);
  return raw <= first_cell_ ? 0 : std::min<size_t>(raw - first_cell_, guide_.size() - 2);
}

size_t NodeIndex::interval(float x) const {
  const size_t c = cell(x);
  size_t low = guide_[c], high = guide_[c + 1];
  while (low < high) {
    const size_t middle = (low + high + 1) / 2;
    if (nodes_[middle] <= x)
      low = middle;
    else
      high = middle - 1;
  }
  return low;
}

}  // namespace turbid
