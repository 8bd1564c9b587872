#include "core/distribution.h"

#include <gtest/gtest.h>

#include <array>
#include <stdexcept>

#include "core/rng.h"

namespace turbid {
namespace {

TEST(DiscreteDistribution, DrawsInProportionAndNeverAnEntryOfWeightZero) {
  const std::array<float, 5> weights = {0, 1, 0, 3, 0};
  const DiscreteDistribution distribution(weights);
  EXPECT_FLOAT_EQ(distribution.prob(1), 0.25f);
  EXPECT_FLOAT_EQ(distribution.prob(3), 0.75f);
  std::array<int, 5> counts = {};
  constexpr int n = 4000;
  for (int i = 0; i < n; ++i) {
    const DiscreteSample sample = distribution.sample((static_cast<float>(i) + 0.5f) / n);
    ++counts[sample.index];
    EXPECT_EQ(sample.prob, distribution.prob(sample.index));
    EXPECT_GE(sample.u, 0);
    EXPECT_LT(sample.u, 1);
  }
  EXPECT_EQ(counts, (std::array<int, 5>{0, 1000, 0, 3000, 0}));
  EXPECT_EQ(distribution.sample(0).index, 1u);
  EXPECT_EQ(distribution.sample(kOneMinusEpsilon).index, 3u);
}

TEST(DiscreteDistribution, RescaledNumberIsUniform) {
  const std::array<float, 3> weights = {0.1f, 0.2f, 0.7f};
  const DiscreteDistribution distribution(weights);
  double sum = 0;
  constexpr int n = 10000;
  for (int i = 0; i < n; ++i) sum += static_cast<double>(distribution.sample((static_cast<float>(i) + 0.5f) / n).u);
  EXPECT_NEAR(sum / n, 0.5, 1e-3);
}

TEST(DiscreteDistribution, RefusesNegativeAndNonFiniteWeights) {
  EXPECT_THROW(DiscreteDistribution(std::array<float, 2>{1, -1}), std::invalid_argument);
  EXPECT_THROW(DiscreteDistribution(std::array<float, 2>{1, NAN}), std::invalid_argument);
  EXPECT_THROW(DiscreteDistribution(std::array<float, 2>{1, INFINITY}), std::invalid_argument);
}

TEST(Distribution2D, DensityOfSamplesIsTheDensityAndIntegratesToOne) {
  const std::array<float, 6> weights = {1, 0, 2, 4, 5, 0};
  const Distribution2D distribution(weights, 3, 2);
  Rng rng(1);
  std::array<double, 6> counts = {};
  constexpr int n = 60000;
  for (int i = 0; i < n; ++i) {
    const auto sample = distribution.sample({rng.next_float(), rng.next_float()});
    ASSERT_GT(sample.pdf_a, 0);
    ASSERT_FLOAT_EQ(sample.pdf_a, distribution.pdf_a(sample.p));
    const size_t x = std::min<size_t>(2, static_cast<size_t>(sample.p.x * 3)), y = sample.p.y < 0.5f ? 0 : 1;
    counts[y * 3 + x] += 1;
  }
  for (size_t i = 0; i < 6; ++i) {
    const double expected = static_cast<double>(weights[i]) / 12;
    EXPECT_NEAR(counts[i] / n, expected, 4 * std::sqrt(expected / n) + 1e-9);
    const Vec2 center{(static_cast<float>(i % 3) + 0.5f) / 3, i < 3 ? 0.25f : 0.75f};
    EXPECT_NEAR(static_cast<double>(distribution.pdf_a(center)), expected * 6, 1e-5);
  }
}

}  // namespace
}  // namespace turbid
