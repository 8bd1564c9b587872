#include "image/z_test.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "core/rng.h"
#include "image/film_image.h"
#include "image/image.h"

namespace turbid {
namespace {

constexpr int kSide = 64;

/// A film of exponentially distributed samples with the given means; the channels share part of their noise.
Film noise_film(uint64_t seed, uint64_t samples, double bias = 1) {
  Film film({kSide, kSide});
  for (size_t i = 0; i < film.pixel_count(); ++i) {
    Rng rng(hash_counters(seed, i));
    for (uint64_t s = 0; s < samples; ++s) {
      const auto shared = static_cast<float>(-std::log(1 - rng.next_double()) * bias);
      const auto own = static_cast<float>(-std::log(1 - rng.next_double()) * bias);
      film.pixel(i).add({Spectrum(shared, 0.5f * shared + 0.5f * own, own), 1});
    }
  }
  film.add_samples(samples);
  return film;
}

XyzImage xyz_of(const Image& image) { return to_xyz(color_channels(image, "image")); }

/// The truth of noise_film: mean 1; variances and covariance of X, Y, Z from the channels' covariance matrix.
struct Truth {
  XyzImage mean, variance;
};
Truth truth() {
  constexpr double kCovariance[3][3] = {{1, 0.5, 0}, {0.5, 0.5, 0.5}, {0, 0.5, 1}};
  constexpr double kMatrix[3][3] = {
      {0.412453, 0.357580, 0.180423}, {0.212671, 0.715160, 0.072169}, {0.019334, 0.119193, 0.950227}};
  Truth t;
  for (size_t c = 0; c < 3; ++c) {
    double mean = 0, variance = 0;
    for (int i = 0; i < 3; ++i) {
      mean += kMatrix[c][i];
      for (int j = 0; j < 3; ++j) variance += kMatrix[c][i] * kMatrix[c][j] * kCovariance[i][j];
    }
    t.mean[c].assign(kSide * kSide, mean);
    t.variance[c].assign(kSide * kSide, variance);
  }
  return t;
}

TEST(VarianceImage, IsThatOfTheXyzComponentsOfOneSample) {
  const XyzImage variance = xyz_of(variance_image(noise_film(1, 1000)));
  const Truth expected = truth();
  for (size_t c = 0; c < 3; ++c) {
    double mean = 0;
    for (const double v : variance[c]) mean += v / static_cast<double>(variance[c].size());
    // Exponential samples: the variance of a sample variance is 8/n; 4096 pixels of 1000 samples.
    EXPECT_NEAR(mean / expected.variance[c][0], 1, 5 * std::sqrt(8.0 / 1000 / 4096)) << c;
  }
}

TEST(VarianceImage, IsZeroForOneSample) {
  const XyzImage variance = xyz_of(variance_image(noise_film(1, 1)));
  EXPECT_EQ(variance[1][5], 0);
}

TEST(MomentLayers, HoldMeanAndSecondMoment) {
  const Film film = noise_film(1, 50);
  const Image image = with_moment_layers(film_to_image(film, false), film, "path");
  EXPECT_EQ(image.channel_names(), (std::vector<std::string>{"R", "G", "B", "path.X", "path.Y", "path.Z", "m2_path.X",
                                                             "m2_path.Y", "m2_path.Z"}));
  const XyzImage variance = xyz_of(variance_image(film));
  for (size_t i = 0; i < 20; ++i) {
    const double mean = static_cast<double>(image.channel("path.Y")[i]);
    const double second = static_cast<double>(image.channel("m2_path.Y")[i]);
    EXPECT_NEAR((second - mean * mean) * 50 / 49, variance[1][i], 1e-5);
  }
}

TEST(ZTest, AcceptsTheSameDistribution) {
  const Truth t = truth();
  const ZTestResult result = z_test(xyz_of(film_to_image(noise_film(2, 1000), false)), 1000, t.mean, t.variance);
  EXPECT_TRUE(result.accepted()) << result.pass_fraction();
  EXPECT_EQ(result.tests, 3u * kSide * kSide);
  EXPECT_NEAR(result.level, 0.01 / (kSide * kSide), 1e-7);
}

/// What a render of `spp` samples looks like: normal by the central limit theorem, times a planted bias.
XyzImage normal_render(const Truth& t, double spp, double bias) {
  XyzImage image = t.mean;
  Rng rng(5);
  for (size_t c = 0; c < 3; ++c) {
    for (size_t i = 0; i < image[c].size(); ++i) {
      const double normal = std::sqrt(-2 * std::log(1 - rng.next_double())) * std::cos(6.283185307 * rng.next_double());
      image[c][i] = bias * (image[c][i] + normal * std::sqrt(t.variance[c][i] / spp));
    }
  }
  return image;
}

TEST(ZTest, RejectsABiasOfOnePercentThatItsSampleCountResolves) {
  const Truth t = truth();
  constexpr uint64_t kSpp = 1'000'000;  // 1 % of the mean is at least 10 standard errors
  EXPECT_TRUE(z_test(normal_render(t, kSpp, 1), kSpp, t.mean, t.variance).accepted());
  EXPECT_FALSE(z_test(normal_render(t, kSpp, 1.01), kSpp, t.mean, t.variance).accepted());
}

TEST(ZTest, FloorsTheVarianceAndFailsNaN) {
  XyzImage reference, image, variance;
  for (size_t c = 0; c < 3; ++c) {
    reference[c] = {1, 1};
    image[c] = {1.0001, std::nan("")};
    variance[c] = {0, 0};
  }
  const ZTestResult result = z_test(image, 100, reference, variance);  // z = 1e-4 sqrt(100 / 1e-4) = 0.1
  EXPECT_EQ(result.passed, 3u);
  EXPECT_EQ(result.tests, 6u);
  EXPECT_EQ(result.worst_index, 1u);
  EXPECT_FALSE(result.accepted());
}

PassStatistics statistics_of(uint64_t seed, double bias, uint64_t samples) {
  PassStatistics statistics({kSide, kSide}, 4);
  for (uint64_t pass = 0; pass < 40; ++pass) statistics.add(noise_film(hash_counters(seed, pass), samples, bias));
  return statistics;
}

TEST(TwoEstimators, AgreeOrAreToldApart) {
  const PassStatistics a = statistics_of(1, 1, 30), b = statistics_of(2, 1, 60), biased = statistics_of(3, 1.05, 60);
  EXPECT_EQ(a.block_count(), 256u);
  EXPECT_NEAR(a.mean(3, 0), 1, 6 / std::sqrt(40 * 30 * 16));
  EXPECT_NEAR(a.variance(3, 0) * 30 * 16, 1, 0.9);
  EXPECT_TRUE(two_estimator_z_test(a, b).accepted()) << two_estimator_z_test(a, b).smallest_p;
  EXPECT_FALSE(two_estimator_z_test(a, biased).accepted());
}

TEST(TwoEstimators, NeedPassesAndTheSameBlocks) {
  PassStatistics a({4, 4}, 2), b({4, 4}, 1);
  EXPECT_THROW(two_estimator_z_test(a, a), std::invalid_argument);
  EXPECT_THROW(two_estimator_z_test(a, b), std::invalid_argument);
  EXPECT_THROW(a.add(Film({2, 2})), std::invalid_argument);
}

TEST(TwoEstimators, PixelsWithoutVarianceMustAgreeWithinRounding) {
  const auto constant = [](float value) {
    PassStatistics statistics({4, 4}, 2);
    for (int pass = 0; pass < 32; ++pass) {
      Film film({4, 4});
      for (size_t i = 0; i < 16; ++i) film.pixel(i).add({Spectrum(value), 1});
      film.add_samples(1);
      statistics.add(film);
    }
    return statistics;
  };
  EXPECT_TRUE(two_estimator_z_test(constant(1), constant(1.000001f)).accepted());
  EXPECT_FALSE(two_estimator_z_test(constant(1), constant(1.0001f)).accepted());
}

}  // namespace
}  // namespace turbid
