#include "table/quadtree_content.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/rng.h"
#include "core/vector.h"
#include "core/warp.h"

namespace turbid {
namespace {

Quadtree tree_about_source(size_t count) {
  Rng rng(3);
  std::vector<Quadtree::Place> places;
  for (size_t i = 0; i < count; ++i) {
    const float r = -2 * std::log(1 - rng.next_float()), u = rng.next_float();
    const Vec3 d = square_to_sphere({u, rng.next_float()});
    places.push_back({r * std::hypot(d.x, d.y), r * d.z});
  }
  return {32, places, {}};
}

// Contents of a known density, and what comes back: the interpolant's content in each leaf is what it was.
TEST(QuadtreeContent, ComesBackFromItsField) {
  const Quadtree tree = tree_about_source(20000);
  const QuadtreeContent content(tree);
  const std::vector<double> even(tree.leaf_count(), 2.5);
  for (const Quadtree::Leaf& leaf : tree.leaves())
    EXPECT_NEAR(content.of(even)[static_cast<size_t>(leaf.number)] / (2.5 * Quadtree::volume(leaf)), 1, 1e-5);
  // e^-r: bends within cells, and falls off by much within the largest ones.
  std::vector<double> contents(tree.leaf_count()), means(tree.leaf_count());
  for (const Quadtree::Leaf& leaf : tree.leaves()) {
    const auto number = static_cast<size_t>(leaf.number);
    constexpr int kSteps = 32;
    double sum = 0, mass = 0;
    for (int i = 0; i < kSteps; ++i)
      for (int j = 0; j < kSteps; ++j) {
        const auto size = static_cast<double>(leaf.size);
        const double rho = static_cast<double>(leaf.rho) + (i + 0.5) / kSteps * size,
                     z = static_cast<double>(leaf.z) + (j + 0.5) / kSteps * size;
        sum += rho * std::exp(-std::hypot(rho, z));
        mass += rho;
      }
    means[number] = sum / mass;
    contents[number] = means[number] * Quadtree::volume(leaf);
  }
  const QuadtreeContent::Field field = content.to_field(contents);
  const std::vector<double> found = content.of(field.values), plain = content.of(means);
  double whole = 0, all = 0, off = 0, plain_off = 0;
  for (size_t leaf = 0; leaf < contents.size(); ++leaf) {
    EXPECT_GE(field.values[leaf], 0);
    EXPECT_NEAR(field.factors[leaf] * found[leaf] / contents[leaf], 1, 0.27);
    whole += contents[leaf];
    all += field.factors[leaf] * found[leaf];
    off += std::abs(field.factors[leaf] * found[leaf] - contents[leaf]);
    plain_off += std::abs(plain[leaf] - contents[leaf]);
  }
  EXPECT_NEAR(all / whole, 1, 1e-6);
  std::printf("off by %.2f %%, plain means by %.2f %%\n", 100 * off / whole, 100 * plain_off / whole);
  EXPECT_LT(off / whole, 0.4 * plain_off / whole);
}

TEST(QuadtreeContent, OfNothingIsNothing) {
  const Quadtree tree = tree_about_source(2000);
  const QuadtreeContent::Field field = QuadtreeContent(tree).to_field(std::vector<double>(tree.leaf_count()));
  for (const double value : field.values) EXPECT_EQ(value, 0);
}

}  // namespace
}  // namespace turbid
