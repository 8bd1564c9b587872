#include "table/quadtree.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <queue>
#include <stdexcept>

namespace turbid {
namespace {

constexpr int kQuarters = 4;

int quarter_of(const Quadtree::Place& place, const Quadtree::Leaf& square) {
  const float half = square.size / 2;
  return (place.rho >= square.rho + half ? 1 : 0) + (place.z >= square.z + half ? 2 : 0);
}

}  // namespace

Quadtree::Leaf Quadtree::root(int number) const {
  const float size = reach_ / 2;
  return {0, size * static_cast<float>(number % kRootsAcross),
          behind() + size * static_cast<float>(number / kRootsAcross), size};
}

Quadtree::Leaf Quadtree::quarter(const Leaf& square, int which) {
  const float half = square.size / 2;
  return {0, which % 2 == 1 ? square.rho + half : square.rho, which >= 2 ? square.z + half : square.z, half};
}

Quadtree::Quadtree(float reach, std::span<const Place> places, const Limits& limits)
    : reach_(reach), nodes_(kRootsAcross * kRootsAlong, -1) {
  struct Cell {
    size_t node;
    Leaf square;
    std::vector<Place> places;
    bool operator<(const Cell& other) const {
      return std::pair(places.size(), other.node) < std::pair(other.places.size(), node);
    }
  };
  std::vector<Cell> roots;
  for (int i = 0; i < kRootsAcross * kRootsAlong; ++i) roots.push_back({static_cast<size_t>(i), root(i), {}});
  for (const Place& place : places) {
    if (!holds(place)) continue;
    const float size = reach_ / 2;
    const auto across = static_cast<size_t>(place.rho / size), along = static_cast<size_t>((place.z - behind()) / size);
    roots[along * kRootsAcross + across].places.push_back(place);
  }
  std::priority_queue<Cell> cells;
  for (Cell& cell : roots) cells.push(std::move(cell));
  leaf_count_ = nodes_.size();
  const auto whole = static_cast<double>(places.size());
  const float smallest = std::ldexp(reach_, -limits.halvings);
  while (!cells.empty() && leaf_count_ + kQuarters - 1 <= limits.leaves) {
    const Cell cell = cells.top();
    cells.pop();
    const bool large = cell.square.size > reach_ / 32;
    if (static_cast<double>(cell.places.size()) <= whole * (large ? limits.rare_share : limits.share)) continue;
    if (cell.square.size <= smallest) continue;
    const size_t first = nodes_.size();
    nodes_[cell.node] = static_cast<int32_t>(first);
    std::vector<Cell> quarters;
    for (int q = 0; q < kQuarters; ++q) {
      nodes_.push_back(-1);
      quarters.push_back({first + static_cast<size_t>(q), quarter(cell.square, q), {}});
    }
    for (const Place& place : cell.places)
      quarters[static_cast<size_t>(quarter_of(place, cell.square))].places.push_back(place);
    for (Cell& each : quarters) cells.push(std::move(each));
    leaf_count_ += kQuarters - 1;
  }
  int32_t leaf = 0;
  for (int32_t& node : nodes_)
    if (node < 0) node = -1 - leaf++;
}

Quadtree::Quadtree(float reach, std::vector<int32_t> nodes) : reach_(reach), nodes_(std::move(nodes)) {
  const auto refuse = [] { throw std::invalid_argument("these nodes are no quadtree"); };
  if (!(reach > 0) || nodes_.size() < kRootsAcross * kRootsAlong) refuse();
  // Children follow their parents, each set of four once, and leaves are numbered in the order of nodes.
  int32_t next = kRootsAcross * kRootsAlong, leaf = 0;
  std::vector<int32_t> first_children;
  for (const int32_t node : nodes_)
    if (node < 0 ? node != -1 - leaf++ : false) refuse();
  leaf_count_ = static_cast<size_t>(leaf);
  for (size_t i = 0; i < nodes_.size(); ++i)
    if (nodes_[i] >= 0) {
      if (nodes_[i] <= static_cast<int32_t>(i)) refuse();
      first_children.push_back(nodes_[i]);
    }
  std::sort(first_children.begin(), first_children.end());
  for (const int32_t child : first_children) {
    if (child != next) refuse();
    next += kQuarters;
  }
  if (static_cast<size_t>(next) != nodes_.size()) refuse();
}

Quadtree::Leaf Quadtree::find(const Place& place) const {
  const float size = reach_ / 2;
  const int across = std::clamp(static_cast<int>(place.rho / size), 0, kRootsAcross - 1);
  const int along = std::clamp(static_cast<int>((place.z - behind()) / size), 0, kRootsAlong - 1);
  int32_t node = along * kRootsAcross + across;
  Leaf square = root(node);
  while (nodes_[static_cast<size_t>(node)] >= 0) {
    const int which = quarter_of(place, square);
    square = quarter(square, which);
    node = nodes_[static_cast<size_t>(node)] + which;
  }
  square.number = -1 - nodes_[static_cast<size_t>(node)];
  return square;
}

void Quadtree::collect(size_t node, const Leaf& square, std::vector<Leaf>& result) const {
  if (nodes_[node] < 0) {
    const int number = -1 - nodes_[node];
    result[static_cast<size_t>(number)] = {number, square.rho, square.z, square.size};
    return;
  }
  for (int q = 0; q < kQuarters; ++q) collect(static_cast<size_t>(nodes_[node] + q), quarter(square, q), result);
}

std::vector<Quadtree::Leaf> Quadtree::leaves() const {
  std::vector<Leaf> result(leaf_count_);
  for (int i = 0; i < kRootsAcross * kRootsAlong; ++i) collect(static_cast<size_t>(i), root(i), result);
  return result;
}

double Quadtree::volume(const Leaf& leaf) {
  const auto inner = static_cast<double>(leaf.rho), size = static_cast<double>(leaf.size);
  return std::numbers::pi * ((inner + size) * (inner + size) - inner * inner) * size;
}

}  // namespace turbid
