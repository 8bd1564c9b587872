// Errors over seeds: their means, uncertainties and what the reference adds, on numbers whose truth is known.
#include "experiment/score.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>

#include "experiment/reference.h"

namespace turbid {
namespace {

constexpr int kPixels = 3000;

/// A method that makes every value of every pixel 1 + bias + noise / sqrt(samples).
struct FakeMethod {
  double noise = 0.5, bias = 0;
  double seconds_per_sample = 0.25;
};

class Scores : public ::testing::Test {
 protected:
  Film film_of(const FakeMethod& method, uint64_t samples) {
    std::normal_distribution<double> normal;
    Film film({kPixels, 1});
    for (size_t i = 0; i < film.pixel_count(); ++i)
      for (uint64_t s = 0; s < samples; ++s) {
        Spectrum value(0.0f);
        for (int c = 0; c < 3; ++c) value[c] = static_cast<float>(1 + method.bias + method.noise * normal(random_));
        film.pixel(i).add(PixelSample{.radiance = value});
      }
    film.add_samples(samples);
    return film;
  }
  Reference reference(double noise, uint64_t samples = 8, uint64_t more = 16) {
    return reference_of(film_of({.noise = noise}, samples), film_of({.noise = noise}, more));
  }

  /// Runs whose curves have 1, 2, 4 ... samples.
  std::vector<Curve> runs_of(const FakeMethod& method, const Reference& reference, int seeds, int points = 3) {
    std::vector<Curve> runs;
    for (int seed = 0; seed < seeds; ++seed) {
      Curve& curve = runs.emplace_back();
      for (int level = 0; level < points; ++level) {
        const uint64_t samples = uint64_t{1} << level;
        Image image({kPixels, 1, {"R", "G", "B"}});
        std::normal_distribution<double> normal;
        for (size_t c = 0; c < 3; ++c)
          for (float& value : image.channel(c))
            value = static_cast<float>(1 + method.bias +
                                       method.noise * normal(random_) / std::sqrt(static_cast<double>(samples)));
        const ImageMetrics metrics = compare_images(color_channels(image, "i"), color_channels(reference.image, "r"));
        const double seconds = method.seconds_per_sample * static_cast<double>(samples);
        curve.push_back({seconds, seconds / 2, samples, level, error_of(metrics)});
      }
    }
    return runs;
  }

  std::mt19937_64 random_{7};
};

TEST_F(Scores, AReferenceKnowsItsOwnError) {
  for (const double noise : {0.1, 1.0}) {
    const Reference made = reference(noise);
    const double truth = noise * noise / 24;
    EXPECT_NEAR(made.error.mse.value, truth, 4 * made.error.mse.error);
    EXPECT_LT(made.error.mse.error, 0.05 * truth);
    EXPECT_NEAR(made.error.by_variance, truth, 0.02 * truth);
    EXPECT_NEAR(made.error.mean, 1, 0.01);
    EXPECT_EQ(made.samples, 24u);
  }
}

TEST_F(Scores, AReferenceWhoseSamplesShareSomethingIsSeenThrough) {
  // One offset for all samples of a half, as when they share lights: the variance between samples knows nothing of it.
  const Reference made =
      reference_of(film_of({.noise = 0.1, .bias = 0.1}, 16), film_of({.noise = 0.1, .bias = -0.1}, 16));
  EXPECT_LT(made.error.by_variance, 0.001);
  EXPECT_NEAR(made.error.mse.value, 0.01, 0.001);
}

TEST_F(Scores, SubtractTheErrorOfTheReference) {
  // The reference is as noisy as the method.
  const Reference made = reference(1.0);
  const FakeMethod method{.noise = 0.5};
  const MethodScore score = score_of(runs_of(method, made, 8), made.error);
  const double truth = 0.25;  // 0.5 / sqrt(4)
  EXPECT_NEAR(score.rmse.value, truth, 4 * score.rmse.error);
  EXPECT_LT(score.rmse.error, 0.05 * truth);
  EXPECT_FALSE(score.is_lost_in_reference);
  EXPECT_NEAR(score.relative.value, truth, 4 * score.rmse.error);
  EXPECT_NEAR(score.cost.value, truth * truth, 4 * score.cost.error);
  EXPECT_NEAR(score.psnr.value, 20 * std::log10(made.error.peak / truth), 4 * score.psnr.error);
  ASSERT_EQ(score.curve.size(), 3u);
  EXPECT_NEAR(*score.slope, -0.5, 0.05);
  // Without that it would be off: the test could tell.
  ReferenceError forgotten = made.error;
  forgotten.mse = {};
  const MethodScore wrong = score_of(runs_of(method, made, 8), forgotten);
  EXPECT_GT(std::abs(wrong.rmse.value - truth), 4 * wrong.rmse.error);
}

TEST_F(Scores, SayWhenTheReferenceIsTooNoisy) {
  const Reference made = reference(1.0, 1, 1);
  EXPECT_TRUE(score_of(runs_of({.noise = 0.1}, made, 4), made.error).is_lost_in_reference);
}

TEST_F(Scores, AreOffByTheirUncertainty) {
  // Over many repetitions, the true error is within one standard error as often as it should be, or almost: with few
  // seeds the standard error itself is uncertain (Student's t of 7 degrees: 65 %).
  int within = 0;
  constexpr int kRepetitions = 60;
  const Reference made = reference(0.02);
  for (int i = 0; i < kRepetitions; ++i) {
    const MethodScore score = score_of(runs_of({.noise = 0.3}, made, 8, 1), made.error);
    within += std::abs(score.rmse.value - 0.3) <= score.rmse.error;
  }
  EXPECT_GT(within, kRepetitions * 0.45);
  EXPECT_LT(within, kRepetitions * 0.85);
}

TEST_F(Scores, KeepABias) {
  const Reference made = reference(0.05, 64, 64);
  const MethodScore score = score_of(runs_of({.noise = 0.01, .bias = -0.2}, made, 4), made.error);
  EXPECT_NEAR(score.rmse.value, 0.2, 0.005);
  EXPECT_NEAR(score.mean_ratio.value, 0.8, 0.005);
  EXPECT_NEAR(*score.slope, 0, 0.02) << "a biased method does not converge";
}

TEST_F(Scores, TellTheTimeToAnError) {
  const Reference made = reference(0.05, 64, 64);
  const std::vector<Curve> runs = runs_of({.noise = 0.5}, made, 6, 6);
  // 0.5 / sqrt(n) = 0.2 at n = 6.25, between two points of the curve.
  const auto score = score_of(runs, made.error, 0.2);
  ASSERT_TRUE(score.seconds_to_error);
  EXPECT_NEAR(score.seconds_to_error->value, 0.25 * 6.25, 0.06);
  EXPECT_FALSE(score_of(runs, made.error, 0.01).seconds_to_error) << "no run came so far";
}

TEST_F(Scores, AverageOnlyMomentsThatAllRunsHave) {
  const Reference made = reference(0.1);
  std::vector<Curve> runs = runs_of({}, made, 3);
  runs[1].erase(runs[1].begin());  // a slow run skipped the first moment
  const MethodScore score = score_of(runs, made.error);
  ASSERT_EQ(score.curve.size(), 2u);
  EXPECT_EQ(score.curve[0].samples, 2);
  runs[2].clear();
  EXPECT_THROW(score_of(runs, made.error), std::invalid_argument);
}

TEST(Estimates, OfMeansAndRatios) {
  const Estimate mean = mean_of({1, 2, 3, 6});
  EXPECT_DOUBLE_EQ(mean.value, 3);
  EXPECT_NEAR(mean.error, std::sqrt((4 + 1 + 0 + 9) / 3.0 / 4), 1e-12);
  EXPECT_TRUE(std::isinf(mean_of({1}).error));
  const Estimate ratio = ratio_of({6, 0.6}, {2, 0.1});
  EXPECT_DOUBLE_EQ(ratio.value, 3);
  EXPECT_NEAR(ratio.error, 3 * std::hypot(0.1, 0.05), 1e-12);
}

TEST(Estimates, OfSlopesAndPercentiles) {
  EXPECT_NEAR(*log_slope({1, 2, 4}, {8, 4, 2}), -1, 1e-12);
  EXPECT_NEAR(*log_slope({1, 2, 4, 8}, {1, 0, 1, 1}), 0, 1e-12) << "0 has no logarithm";
  EXPECT_FALSE(log_slope({1}, {1}));
  EXPECT_FALSE(log_slope({3, 3}, {1, 2}));
  std::vector<float> values(1000);
  std::iota(values.begin(), values.end(), 0.0f);
  values.push_back(INFINITY);
  EXPECT_EQ(percentile(values, 0.99), 990);
  EXPECT_EQ(percentile({}, 0.99), 0);
}

TEST(MethodScores, HaveAllMeasuresThatTheyName) {
  for (const std::string& name : MethodScore::measures()) EXPECT_NO_THROW((void)MethodScore().get(name)) << name;
  EXPECT_THROW((void)MethodScore().get("beauty"), std::invalid_argument);
}

}  // namespace
}  // namespace turbid
