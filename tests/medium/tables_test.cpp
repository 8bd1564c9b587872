// What tables are made with: search among nodes, refinement; and the table over angles itself.
#include <gtest/gtest.h>

#include <numbers>

#include "core/rng.h"
#include "core/vector.h"
#include "medium/angular_table_phase.h"
#include "medium/henyey_greenstein.h"
#include "medium/node_index.h"
#include "medium/refinement.h"

namespace turbid {
namespace {

TEST(NodeIndex, FindsWhatASearchFromTheStartFinds) {
  Rng rng(1);
  for (const float exponent : {1.0f, 6.0f, 30.0f}) {  // from even to crowded towards 0
    std::vector<float> nodes{0};
    for (int i = 0; i < 500; ++i) nodes.push_back(3 * std::pow(rng.next_float(), exponent));
    nodes.insert(nodes.end(), {0.5f, 0.5f, 0.5f, 0, 0});  // equal ones too
    std::sort(nodes.begin(), nodes.end());
    const NodeIndex index(nodes);
    std::vector<float> places = nodes;
    for (int i = 0; i < 5000; ++i) places.push_back(4 * std::pow(rng.next_float(), exponent));
    for (const float x : places) {
      size_t expected = 0;
      while (expected + 2 < nodes.size() && nodes[expected + 1] <= x) ++expected;
      ASSERT_EQ(index.interval(x), expected) << x;
    }
  }
}

TEST(NodeIndex, RefusesWhatDoesNotAscendFromZero) {
  EXPECT_THROW(NodeIndex({0}), std::invalid_argument);
  EXPECT_THROW(NodeIndex({1, 2}), std::invalid_argument);
  EXPECT_THROW(NodeIndex({0, 2, 1}), std::invalid_argument);
  EXPECT_THROW(NodeIndex({0, 0}), std::invalid_argument);
  EXPECT_THROW(NodeIndex({0, std::numeric_limits<float>::infinity()}), std::invalid_argument);
}

double identity(double x) { return x; }

TEST(Refinement, MeetsItsTolerance) {
  const auto peak = [](double x) { return 1 / (1e-4 + x * x); };
  const std::vector<Node> nodes = refine(peak, identity, {0, 0.3, 1}, {.tolerance = 1e-3});
  EXPECT_LT(nodes.size(), 600u);
  for (size_t i = 0; i + 1 < nodes.size(); ++i)
    for (const double t : {0.25, 0.5, 0.75}) {
      const double x = nodes[i].at + t * (nodes[i + 1].at - nodes[i].at);
      const double line = nodes[i].value + t * (nodes[i + 1].value - nodes[i].value);
      ASSERT_NEAR(line / peak(x), 1, 6e-4) << x;
    }
}

TEST(Refinement, LeavesStraightLinesAlone) {
  EXPECT_EQ(refine([](double x) { return 1 + x; }, identity, {0, 1, 5}).size(), 3u);
  // Straight in the coordinate, not in the place.
  EXPECT_EQ(refine([](double x) { return x * x; }, [](double x) { return x * x; }, {0, 1, 5}).size(), 3u);
}

TEST(Refinement, NarrowsAJumpAndStops) {
  const auto step = [](double x) { return x < 0.7 ? 1.0 : 3.0; };
  const std::vector<Node> nodes = refine(step, identity, {0, 1});
  EXPECT_LT(nodes.size(), 60u);
  double widest = 0;
  for (size_t i = 0; i + 1 < nodes.size(); ++i)
    if (nodes[i].value != nodes[i + 1].value) widest = std::max(widest, nodes[i + 1].at - nodes[i].at);
  EXPECT_GT(widest, 0);
  EXPECT_LT(widest, 2e-6);
}

TEST(AngularTable, ResemblesWhatWasTabulated) {
  const HenyeyGreensteinPhase hg(0.99f);
  std::vector<double> start{0};
  for (double theta = 1e-4; theta < std::numbers::pi; theta *= 1.3) start.push_back(theta);
  start.push_back(std::numbers::pi);
  const std::vector<Node> nodes =
      refine([&](double theta) { return 7 * static_cast<double>(hg.eval_angle(static_cast<float>(theta))); },
             [](double theta) { return sqr(std::sin(theta / 2)); }, start);
  const AngularTablePhase table(nodes);
  EXPECT_NEAR(table.integral(), 7, 1e-3);
  EXPECT_NEAR(table.mean_cosine(), 0.99f, 1e-5f);
  for (const float theta : {0.0f, 1e-3f, 0.01f, 0.5f, 2.0f, 3.14f})
    EXPECT_NEAR(table.eval_angle(theta) / hg.eval_angle(theta), 1, 5e-4) << theta;
  for (const float u : {0.0f, 0.1f, 0.5f, 0.9f}) {
    const float expected = 1 - hg.sample(u);
    EXPECT_NEAR(1 - table.sample(u), expected, 2e-3f * expected) << u;
  }
}

TEST(AngularTable, RefusesBadNodes) {
  constexpr double kEnd = std::numbers::pi;
  const auto make = [](const std::vector<Node>& nodes) { return AngularTablePhase(nodes); };
  EXPECT_THROW(make({{0, 1}}), std::invalid_argument);
  EXPECT_THROW(make({{0, 1}, {3, 1}}), std::invalid_argument);
  EXPECT_THROW(make({{0.1, 1}, {kEnd, 1}}), std::invalid_argument);
  EXPECT_THROW(make({{0, 0}, {kEnd, 0}}), std::invalid_argument);
  EXPECT_THROW(make({{0, 1}, {1, -1}, {kEnd, 1}}), std::invalid_argument);
  EXPECT_THROW(make({{0, std::numeric_limits<double>::infinity()}, {kEnd, 1}}), std::invalid_argument);
}

}  // namespace
}  // namespace turbid
