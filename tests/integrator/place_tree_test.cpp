#include "integrator/place_tree.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/rng.h"

namespace turbid {
namespace {

struct Sources {
  std::vector<Vec3> places;
  std::vector<float> strengths;
};

Sources scattered_sources(size_t count) {
  Sources sources;
  Rng rng(5);
  for (size_t i = 0; i < count; ++i) {
    sources.places.push_back({rng.next_float(), rng.next_float(), 0.2f * rng.next_float()});
    sources.strengths.push_back(i % 7 == 3 ? 0 : rng.next_float());
  }
  return sources;
}

float falloff(float distance2) { return 1 / (0.01f + distance2); }

TEST(PlaceTree, DrawsAsOftenAsItExpects) {
  constexpr size_t kSources = 37;
  constexpr int kDraws = 5, kRounds = 40'000;
  const Sources sources = scattered_sources(kSources);
  const PlaceTree tree(sources.places, sources.strengths);
  const Vec3 seen(0.3f, 0.6f, 0.1f);
  std::vector<double> drawn(kSources, 0), expected(kSources, 0);
  Rng rng(1);
  int fewest = kDraws, most = 0;
  for (int round = 0; round < kRounds; ++round) {
    int count = 0;
    tree.draw(seen, kDraws, rng.next_double(), falloff, [&](uint32_t i, double e) {
      ++count;
      drawn[i] += 1.0 / kRounds;
      expected[i] = e;
    });
    fewest = std::min(fewest, count);
    most = std::max(most, count);
  }
  EXPECT_GE(fewest, kDraws - 1);  // rounding in the last sum
  EXPECT_LE(most, kDraws);
  double sum = 0;
  for (size_t i = 0; i < kSources; ++i) {
    // Within a round a source is drawn floor(e) or ceil(e) times: the variance is at most 1/4.
    EXPECT_NEAR(drawn[i], expected[i], 5 * 0.5 / std::sqrt(kRounds)) << i;
    EXPECT_EQ(sources.strengths[i] == 0, expected[i] == 0) << i;
    sum += expected[i];
  }
  EXPECT_NEAR(sum, kDraws, 1e-6);
}

TEST(PlaceTree, SumsAreUnbiasedAndNearSourcesArePreferred) {
  const Sources sources = scattered_sources(1000);
  const PlaceTree tree(sources.places, sources.strengths);
  const Vec3 seen(0.5f, 0.5f, 0.1f);
  const auto brought = [&](uint32_t i) {
    return static_cast<double>(sources.strengths[i] * falloff(length_squared(sources.places[i] - seen)));
  };
  double truth = 0, blind = 0;
  for (uint32_t i = 0; i < 1000; ++i) {
    truth += brought(i);
    // The second moment where sources are drawn by strength alone.
    if (sources.strengths[i] > 0)
      blind += brought(i) * brought(i) * tree.strength() / static_cast<double>(sources.strengths[i]);
  }
  constexpr int kRounds = 20'000;
  double sum = 0, squares = 0;
  Rng rng(2);
  for (int round = 0; round < kRounds; ++round) {
    double value = 0;
    tree.draw(seen, 1, rng.next_double(), falloff, [&](uint32_t i, double e) { value += brought(i) / e; });
    sum += value / kRounds;
    squares += value * value / kRounds;
  }
  const double variance = squares - sum * sum;
  EXPECT_NEAR(sum, truth, 5 * std::sqrt(variance / kRounds));
  EXPECT_LT(variance, 0.2 * (blind - truth * truth));
}

TEST(PlaceTree, HasNothingToDrawWhereThereIsNone) {
  const auto draws = [](const PlaceTree& tree) {
    int count = 0;
    tree.draw(Vec3(0), 3, 0.5, falloff, [&](uint32_t, double) { ++count; });
    return count;
  };
  EXPECT_EQ(draws(PlaceTree()), 0);
  const Vec3 places[] = {{0, 0, 0}, {0, 0, 0}};
  const float dark[] = {0, 0}, one_bright[] = {0, 2};
  EXPECT_EQ(draws(PlaceTree(places, dark)), 0);
  EXPECT_EQ(draws(PlaceTree(places, one_bright)), 3);  // two in one place
}

}  // namespace
}  // namespace turbid
