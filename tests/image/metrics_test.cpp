#include "image/metrics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

namespace turbid {
namespace {

TEST(Metrics, HandComputedValues) {
  const std::vector<float> image{1, 2, 3, 4}, reference{1, 1, 4, 2};
  const ImageMetrics m = compare_images({image}, {reference});
  EXPECT_DOUBLE_EQ(m.rmse, std::sqrt(6.0 / 4));
  EXPECT_DOUBLE_EQ(m.mae, 1);
  EXPECT_DOUBLE_EQ(m.peak, 4);
  EXPECT_DOUBLE_EQ(m.psnr, 20 * std::log10(4 / std::sqrt(1.5)));
  EXPECT_DOUBLE_EQ(m.rel_mse, (1 / 1.01 + 1 / 16.01 + 4 / 4.01) / 4);
  EXPECT_DOUBLE_EQ(m.mean_ratio, 10.0 / 8);
  EXPECT_EQ(m.non_finite, 0u);
}

TEST(Metrics, EqualImages) {
  const std::vector<float> image{1, 2};
  const ImageMetrics m = compare_images({image, image, image}, {image, image, image});
  EXPECT_EQ(m.rmse, 0);
  EXPECT_EQ(m.psnr, std::numeric_limits<double>::infinity());
  EXPECT_EQ(m.channel_mean_ratios, (std::vector<double>{1, 1, 1}));
}

TEST(Metrics, LeavesOutWhatIsNotFiniteAndCountsIt) {
  const std::vector<float> image{1, std::numeric_limits<float>::infinity(), 3}, reference{1, 1, std::nanf("")};
  const ImageMetrics m = compare_images({image}, {reference});
  EXPECT_EQ(m.non_finite, 2u);
  EXPECT_EQ(m.rmse, 0);
  EXPECT_EQ(m.mean_ratio, 1);
}

TEST(Metrics, RefusesDifferentSizes) {
  const std::vector<float> a{1, 2}, b{1};
  EXPECT_THROW(compare_images({a}, {b}), std::invalid_argument);
  EXPECT_THROW(compare_images({a}, {a, a}), std::invalid_argument);
}

}  // namespace
}  // namespace turbid
