// Splats: sums that do not depend on order, and pixels chosen so that each receives what its filter sees.
#include "image/splat_buffer.h"

#include <gtest/gtest.h>

#include <map>

#include "core/parallel.h"
#include "core/rng.h"

namespace turbid {
namespace {

const ReconstructionFilter kFilters[] = {{ReconstructionFilter::Kind::kBox, 0.5f},
                                         {ReconstructionFilter::Kind::kBox, 1.3f},
                                         {ReconstructionFilter::Kind::kTent, 1},
                                         {ReconstructionFilter::Kind::kGaussian, 0.5f}};

TEST(ReconstructionFilter, DensityIsThatOfItsSamples) {
  for (const ReconstructionFilter& filter : kFilters) {
    constexpr int kBins = 40, kSamples = 400000;
    const float width = 2 * filter.support() / kBins;
    std::vector<int> counts(kBins);
    Rng rng(1);
    for (int i = 0; i < kSamples; ++i) {
      const auto bin = static_cast<int>((filter.sample({rng.next_float(), 0.5f}).x + filter.support()) / width);
      ++counts[static_cast<size_t>(std::clamp(bin, 0, kBins - 1))];
    }
    double sum = 0;
    for (int bin = 0; bin < kBins; ++bin) {
      double mass = 0;  // midpoint rule, fine enough for the statistics
      for (int k = 0; k < 20; ++k)
        mass += static_cast<double>(
            filter.pdf_1d(-filter.support() + width * (static_cast<float>(bin) + (static_cast<float>(k) + 0.5f) / 20)));
      mass *= static_cast<double>(width) / 20;
      sum += mass;
      const double expected = mass * kSamples;
      EXPECT_LT(std::abs(counts[static_cast<size_t>(bin)] - expected), 4 * std::sqrt(expected) + 2) << bin;
    }
    EXPECT_NEAR(sum, 1, 1e-3);
    EXPECT_EQ(filter.pdf_1d(filter.support() * 1.001f), 0);
  }
}

TEST(ChoosePixel, GivesEveryPixelTheDensityOfItsFilter) {
  for (const ReconstructionFilter& filter : kFilters) {
    const Vec2 position(3.2f, 5.9f);
    constexpr int kSamples = 200000;
    std::map<std::pair<int, int>, double> sums;
    float weight = 0;
    Rng rng(7);
    for (int i = 0; i < kSamples; ++i) {
      const float u = rng.next_float();
      const SplatTarget target = choose_pixel(filter, position, {u, rng.next_float()});
      weight = target.weight;
      sums[{target.pixel.x, target.pixel.y}] += static_cast<double>(target.weight) / kSamples;
    }
    for (int y = 0; y < 12; ++y) {
      for (int x = 0; x < 12; ++x) {
        const double expected = static_cast<double>(filter.pdf_1d(3.2f - static_cast<float>(x) - 0.5f) *
                                                    filter.pdf_1d(5.9f - static_cast<float>(y) - 0.5f));
        const double error = std::sqrt(expected * static_cast<double>(weight) / kSamples);
        EXPECT_NEAR((sums[{x, y}]), expected, 4 * error + 1e-5) << x << ", " << y;
      }
    }
  }
}

TEST(SplatBuffer, SumsAreTheSameInAnyOrder) {
  SplatBuffer forward({3, 2}, 4), backward({3, 2}, 4);
  Rng rng(3);
  std::vector<std::pair<size_t, Spectrum>> splats;
  std::vector<double> sums(6);
  for (int i = 0; i < 20000; ++i) {
    const size_t pixel = rng.next_u32() % 6;
    const float value = std::exp(10 * rng.next_float() - 8);
    splats.push_back({pixel, {value, 0.5f * value, 0}});
    sums[pixel] += static_cast<double>(value);
  }
  for (const auto& [pixel, value] : splats) forward.add(pixel, value);
  parallel_for(splats.size(), [&](size_t i) {
    const auto& [pixel, value] = splats[splats.size() - 1 - i];
    backward.add(pixel, value);
  });
  for (size_t pixel = 0; pixel < 6; ++pixel) {
    EXPECT_EQ(forward.sum(pixel), backward.sum(pixel));
    EXPECT_NEAR(forward.sum(pixel)[0] / sums[pixel], 1, 1e-6);
    EXPECT_NEAR(forward.sum(pixel)[1] / sums[pixel], 0.5, 1e-6);
    EXPECT_EQ(forward.sum(pixel)[2], 0);
  }
  EXPECT_EQ(forward.saturated(), 0u);
  forward.clear();
  EXPECT_EQ(forward.sum(0), Spectrum(0.0f));
}

TEST(SplatBuffer, CutsOffWhatIsBeyondItsRangeAndCountsIt) {
  SplatBuffer splats({1, 1}, 0);
  const float most = std::ldexp(1.0f, SplatBuffer::kHeadroomBits);
  splats.add(0, {1, most, 1e30f});
  EXPECT_EQ(splats.sum(0), Spectrum(1, most, most));
  EXPECT_EQ(splats.saturated(), 1u);
}

}  // namespace
}  // namespace turbid
