#include "image/filter.h"

#include <gtest/gtest.h>

#include <cmath>

#include "testing/chi_square.h"

namespace turbid {
namespace {

using Kind = ReconstructionFilter::Kind;

constexpr int kSamples = 1'000'000;

testing::ChiSquareResult judge(const ReconstructionFilter& filter, double support, bool along_x,
                               const std::function<double(double)>& shape) {
  const double mass = testing::integrate_interval(shape, -support, support, 1e-9, 3);
  const auto sample = [&](Rng& rng) -> std::optional<double> {
    const float u = rng.next_float();
    const Vec2 p = filter.sample({u, rng.next_float()});
    return static_cast<double>(along_x ? p.x : p.y);
  };
  testing::ChiSquareSettings settings;
  settings.samples = kSamples;
  return testing::chi_square_interval(
      sample, [&](double x) { return shape(x) / mass; }, -support, support, settings);
}

double gaussian(double x, double stddev) {
  return std::max(0.0, std::exp(-x * x / (2 * stddev * stddev)) - std::exp(-8.0));
}

TEST(Filter, BoxTentAndGaussianFollowTheirShapes) {
  for (const bool along_x : {true, false}) {
    const auto box = judge({Kind::kBox, 0.5f}, 0.5, along_x, [](double) { return 1.0; });
    EXPECT_TRUE(testing::passes(box, 6)) << box.report;
    const auto tent = judge({Kind::kTent, 1.5f}, 1.5, along_x, [](double x) { return 1.5 - std::abs(x); });
    EXPECT_TRUE(testing::passes(tent, 6)) << tent.report;
    const auto gauss = judge({Kind::kGaussian, 0.5f}, 2, along_x, [](double x) { return gaussian(x, 0.5); });
    EXPECT_TRUE(testing::passes(gauss, 6)) << gauss.report;
  }
}

TEST(Filter, TheTestNoticesAGaussianThatIsOnePercentTooWide) {
  const auto wide = judge({Kind::kGaussian, 0.505f}, 2.02, true, [](double x) { return gaussian(x, 0.5); });
  EXPECT_FALSE(testing::passes(wide));
}

TEST(Filter, TheTestNoticesAGaussianThatIsNotShiftedToZeroAtItsEnd) {
  const auto shifted = judge({Kind::kGaussian, 0.5f}, 2, true, [](double x) { return std::exp(-x * x / 0.5); });
  EXPECT_FALSE(testing::passes(shifted));
}

TEST(Filter, StaysInsideItsSupportForAllNumbers) {
  for (const float u : {0.0f, 0x1p-24f, 0.5f, kOneMinusEpsilon}) {
    const Vec2 p = ReconstructionFilter(Kind::kGaussian, 0.5f).sample({u, u});
    EXPECT_LE(std::abs(p.x), 2.0f);
    const Vec2 q = ReconstructionFilter(Kind::kTent, 1).sample({u, u});
    EXPECT_LE(std::abs(q.y), 1.0f);
  }
  EXPECT_EQ(ReconstructionFilter(Kind::kGaussian, 0.5f).sample({0.5f, 0.5f}), Vec2(0, 0));
}

}  // namespace
}  // namespace turbid
