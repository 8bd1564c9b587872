#include "table/quadtree_content.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "core/gauss_legendre.h"

namespace turbid {

QuadtreeCorners::QuadtreeCorners(const Quadtree& tree, const Quadtree::Place& place) {
  const Quadtree::Leaf own = tree.find(place);
  const float rho = own.rho + own.size / 2, z = own.z + own.size / 2;
  const float by_rho = std::abs(place.rho - rho) / own.size, by_z = std::abs(place.z - z) / own.size;
  const float next_rho = rho + std::copysign(own.size, place.rho - rho);
  const float next_z = z + std::copysign(own.size, place.z - z);
  const auto set = [&](size_t corner, float at_rho, float at_z, float weight) {
    const Quadtree::Place there{std::abs(at_rho), at_z};
    leaves[corner] = static_cast<size_t>(tree.holds(there) ? tree.find(there).number : own.number);
    weights[corner] = weight;
    beyond[corner] = at_rho < 0;
  };
  leaves[0] = static_cast<size_t>(own.number);
  weights[0] = (1 - by_z) * (1 - by_rho);
  beyond[0] = false;
  set(1, next_rho, z, (1 - by_z) * by_rho);
  set(2, rho, next_z, by_z * (1 - by_rho));
  set(3, next_rho, next_z, by_z * by_rho);
}

QuadtreeContent::QuadtreeContent(const Quadtree& tree) : rows_(tree.leaf_count()), volumes_(tree.leaf_count()) {
  // In each quarter of a leaf the four look-ups are the same, and weights are bilinear.
  const GaussLegendre rule(2);
  for (const Quadtree::Leaf& leaf : tree.leaves()) {
    std::vector<Share>& row = rows_[static_cast<size_t>(leaf.number)];
    const auto half = static_cast<double>(leaf.size) / 2;
    for (size_t i = 0; i < 2 * rule.size(); ++i)
      for (size_t j = 0; j < 2 * rule.size(); ++j) {
        const auto node = [&](size_t k) { return half * (rule.node(k % 2) + static_cast<double>(k / 2)); };
        const double rho = static_cast<double>(leaf.rho) + node(i), z = static_cast<double>(leaf.z) + node(j);
        const double volume = 2 * std::numbers::pi * rho * half * half * rule.weight(i % 2) * rule.weight(j % 2);
        const QuadtreeCorners corners(tree, {static_cast<float>(rho), static_cast<float>(z)});
        for (size_t k = 0; k < 4; ++k)
          row.push_back({corners.leaves[k], volume * static_cast<double>(corners.weights[k])});
      }
    std::sort(row.begin(), row.end(), [](const Share& a, const Share& b) { return a.leaf < b.leaf; });
    size_t last = 0;
    for (size_t k = 1; k < row.size(); ++k) {
      if (row[k].leaf == row[last].leaf)
        row[last].volume += row[k].volume;
      else
        row[++last] = row[k];
    }
    row.resize(last + 1);
    volumes_[static_cast<size_t>(leaf.number)] = Quadtree::volume(leaf);
  }
}

std::vector<double> QuadtreeContent::of(std::span<const double> values) const {
  std::vector<double> contents(rows_.size());
  for (size_t leaf = 0; leaf < rows_.size(); ++leaf)
    for (const Share& share : rows_[leaf]) contents[leaf] += share.volume * values[share.leaf];
  return contents;
}

QuadtreeContent::Field QuadtreeContent::to_field(std::span<const double> contents) const {
  // Each round multiplies a value by what its leaf and those around it should have over what they have: the mean over
  // those that it is interpolated with. What interpolation adds or takes changes slowly from leaf to leaf and is made
  // good in few rounds; the contents' noise does not, and is left to be smoothed.
  constexpr int kRounds = 3;
  constexpr double kMost = 1.25;
  const size_t leaves = contents.size();
  Field field{std::vector<double>(leaves), std::vector<double>(leaves, 1)};
  for (size_t leaf = 0; leaf < leaves; ++leaf) field.values[leaf] = contents[leaf] / volumes_[leaf];
  const std::vector<double> means = field.values;
  std::vector<double> found = of(field.values), missing(leaves);
  for (int round = 0; round < kRounds; ++round) {
    for (size_t leaf = 0; leaf < leaves; ++leaf)
      missing[leaf] = contents[leaf] > 0 ? std::log(contents[leaf] / found[leaf]) : 0;
    for (size_t leaf = 0; leaf < leaves; ++leaf) {
      double sum = 0;
      for (const Share& share : rows_[leaf]) sum += share.volume * missing[share.leaf];
      field.values[leaf] =
          std::clamp(field.values[leaf] * std::exp(sum / volumes_[leaf]), 0.3 * means[leaf], 3 * means[leaf]);
    }
    found = of(field.values);
  }
  for (size_t leaf = 0; leaf < leaves; ++leaf)
    if (found[leaf] > kMost * contents[leaf] || kMost * found[leaf] < contents[leaf]) {
      field.factors[leaf] = contents[leaf] / found[leaf];
      found[leaf] = contents[leaf];
    }
  const double factor = std::accumulate(contents.begin(), contents.end(), 0.0) /
                        std::max(std::accumulate(found.begin(), found.end(), 0.0), 1e-300);
  for (double& value : field.values) value *= factor;
  return field;
}

}  // namespace turbid
