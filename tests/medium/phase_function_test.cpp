// Phase functions: each is a density over the sphere, is sampled as it says, and has the mean cosine that it says.
#include "medium/phase_function.h"

#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "medium/blend_phase.h"
#include "medium/henyey_greenstein.h"
#include "medium/isotropic.h"
#include "medium/phases_for_tests.h"
#include "medium/rayleigh.h"
#include "medium/tabulated_phase.h"

namespace turbid {
namespace {

using testing::all_phase_functions;
using testing::moment;
using testing::test_samples;

constexpr double kTwoPi = 2 * std::numbers::pi;

TEST(PhaseFunction, IntegratesToOne) {
  for (const auto& [name, phase, grows] : all_phase_functions())
    EXPECT_NEAR(moment(*phase, [](double) { return 1.0; }), 1, 2e-5) << name;
}

TEST(PhaseFunction, HasTheMeanCosineItClaims) {
  for (const auto& [name, phase, grows] : all_phase_functions())
    EXPECT_NEAR(moment(*phase, [](double mu) { return mu; }), static_cast<double>(phase->mean_cosine()), 2e-5) << name;
}

TEST(PhaseFunction, IsSampledAsItSays) {
  const auto all = all_phase_functions();
  for (const auto& [name, phase, grows] : all) {
    const auto result = test_samples(*phase, *phase);
    EXPECT_TRUE(passes(result, static_cast<int>(all.size()))) << name << ": " << result.report;
  }
}

TEST(PhaseFunction, CosinesThatRoundingPutsBeyondOneCountAsOne) {
  constexpr float kBeyond = 1 + 4e-7f;  // dot products of unit vectors reach this
  for (const auto& [name, phase, grows] : all_phase_functions())
    for (const float sign : {-1.0f, 1.0f})
      EXPECT_NEAR(phase->eval(sign * kBeyond) / (1e-30f + phase->eval(sign)), 1, phase->eval(sign) > 0 ? 1e-5 : 1)
          << name;
}

TEST(PhaseFunction, PlantedErrorsAreFound) {
  const HenyeyGreensteinPhase right(0.5f), wrong(0.52f), mirrored(-0.5f);
  EXPECT_FALSE(passes(test_samples(right, wrong), 100)) << "slightly wrong g";
  EXPECT_FALSE(passes(test_samples(right, mirrored), 100)) << "wrong sign convention";
  EXPECT_FALSE(passes(test_samples(RayleighPhase(), IsotropicPhase()), 100));
}

TEST(PhaseFunction, SamplesStayInRangeAndGrowWithU) {
  for (const auto& [name, phase, grows] : all_phase_functions()) {
    float last = -1;
    for (int i = 0; i <= 1000; ++i) {
      const float mu = phase->sample(std::min(static_cast<float>(i) / 1000, kOneMinusEpsilon));
      ASSERT_GE(mu, -1) << name;
      ASSERT_LE(mu, 1) << name;
      if (!grows) continue;
      ASSERT_GE(mu, last - 1e-6f) << name << " at " << i;
      last = mu;
    }
  }
}

TEST(PhaseFunction, IsTheSameByAngleAsByCosine) {
  for (const auto& [name, phase, grows] : all_phase_functions())
    for (float theta = 0.1f; theta < 3.05f; theta += 0.0373f) {
      const float by_angle = phase->eval_angle(theta), by_cosine = phase->eval(std::cos(theta));
      EXPECT_NEAR(by_cosine, by_angle, 2e-4f * by_angle) << name << " at " << theta;
    }
}

TEST(PhaseFunction, IsFiniteAtBothEnds) {
  for (const auto& [name, phase, grows] : all_phase_functions())
    for (const float mu : {-1.0f, 1.0f}) {
      EXPECT_TRUE(std::isfinite(phase->eval(mu)) && phase->eval(mu) >= 0) << name;
      EXPECT_NEAR(phase->eval_angle(mu > 0 ? 0 : kPi), phase->eval(mu), 1e-5f * phase->eval(mu)) << name;
    }
}

/// The textbook formula in long double.
double reference_hg(double g, double mu) {
  const long double gl = g, squared = 1 + gl * gl - 2 * gl * static_cast<long double>(mu);
  return static_cast<double>((1 - gl * gl) / (4 * std::numbers::pi_v<long double> * squared * std::sqrt(squared)));
}

TEST(HenyeyGreenstein, KeepsItsDigitsEverywhere) {
  for (const float g : {-0.9999f, -0.99f, -0.5f, -1e-8f, 0.0f, 1e-8f, 1e-4f, 0.5f, 0.99f, 0.9999f})
    for (const float mu : {-1.0f, -0.999999f, -0.5f, 0.0f, 0.5f, 0.999999f, 1.0f}) {
      const double expected = reference_hg(static_cast<double>(g), static_cast<double>(mu));
      EXPECT_NEAR(static_cast<double>(HenyeyGreensteinPhase(g).eval(mu)) / expected, 1, 1e-6) << g << ' ' << mu;
    }
}

TEST(HenyeyGreenstein, KeepsItsDigitsByAngle) {
  // 1 - mu = 2 sin^2(theta/2), in long double.
  for (const float g : {-0.9999f, -0.9f, 0.0f, 0.9f, 0.999f, 0.99999f})
    for (const float theta : {0.0f, 1e-6f, 1e-5f, 1e-4f, 1e-3f, 0.1f, 2.0f, 3.1f, 3.14159f}) {
      const long double gl = g, half = std::sin(static_cast<long double>(theta) / 2);
      const long double squared = (1 - gl) * (1 - gl) + 4 * gl * half * half;
      const long double expected = (1 - gl * gl) / (4 * std::numbers::pi_v<long double> * squared * std::sqrt(squared));
      EXPECT_NEAR(static_cast<double>(HenyeyGreensteinPhase(g).eval_angle(theta) / expected), 1, 2e-6)
          << g << ' ' << theta;
    }
}

TEST(HenyeyGreenstein, InvertsItsCdf) {
  // F(mu) = (1 - g^2) / (2 g) (1 / sqrt(1 + g^2 - 2 g mu) - 1 / (1 + g)); for g < 0 the samples fall with u.
  for (const double g : {-0.9, -0.1, 0.05, 0.5, 0.95})
    for (const double u : {0.0, 0.001, 0.2, 0.5, 0.8, 0.999}) {
      const double mu = static_cast<double>(
          HenyeyGreensteinPhase(static_cast<float>(g)).sample(static_cast<float>(g > 0 ? u : 1 - u)));
      if (g < 0 && u == 0) continue;
      const double cdf = (1 - g * g) / (2 * g) * (1 / std::sqrt(1 + g * g - 2 * g * mu) - 1 / (1 + g));
      // mu is rounded to a float: that moves the CDF by half a step (6e-8) times its slope, on top of the arithmetic.
      const double slope = kTwoPi * reference_hg(g, mu);
      EXPECT_NEAR(cdf, u, 1e-6 + 1.2e-7 * slope) << g;
    }
}

TEST(HenyeyGreenstein, RefusesImpossibleMeanCosines) {
  for (const float g : {1.0f, -1.0f, 1.5f, std::numeric_limits<float>::quiet_NaN()})
    EXPECT_THROW(HenyeyGreensteinPhase{g}, std::invalid_argument) << g;
}

TEST(BlendPhase, RefusesWeightsOutsideTheUnitInterval) {
  const auto phase = std::make_shared<IsotropicPhase>();
  for (const float w : {-0.1f, 1.1f, std::numeric_limits<float>::quiet_NaN()})
    EXPECT_THROW(BlendPhase(phase, phase, w), std::invalid_argument) << w;
}

TEST(BlendPhase, AtItsEndsIsOneOfTheTwo) {
  const auto first = std::make_shared<HenyeyGreensteinPhase>(0.6f),
             second = std::make_shared<HenyeyGreensteinPhase>(-0.2f);
  const BlendPhase only_first(first, second, 0), only_second(first, second, 1);
  for (const float u : {0.0f, 0.3f, kOneMinusEpsilon}) {
    constexpr float kRounding = 4 * 0x1p-24f;  // of mu in [-1, 1]: inlined copies may fuse products differently
    EXPECT_NEAR(only_first.sample(u), first->sample(u), kRounding);
    EXPECT_NEAR(only_second.sample(u), second->sample(u), kRounding);
  }
}

TEST(TabulatedPhase, ReadsItsValuesFromBackToForward) {
  // Mitsuba's order: the last value belongs to light that goes straight on.
  const TabulatedPhase forward(std::array{0.0f, 1.0f});
  EXPECT_FLOAT_EQ(forward.eval(1), 1 / (2 * kPi));
  EXPECT_EQ(forward.eval(-1), 0);
  EXPECT_FLOAT_EQ(forward.mean_cosine(), 1.0f / 3);
  EXPECT_NEAR(forward.sample(0.25f), 0, 1e-7f);  // F(mu) = (1 + mu)^2 / 4
}

TEST(TabulatedPhase, ResemblesWhatWasTabulated) {
  const HenyeyGreensteinPhase hg(0.5f);
  std::vector<float> values;
  for (int i = 0; i <= 2000; ++i) values.push_back(7 * hg.eval(-1 + static_cast<float>(i) / 1000));
  const TabulatedPhase table(values);
  for (const float mu : {-1.0f, -0.3333f, 0.1234f, 0.9f, 1.0f}) EXPECT_NEAR(table.eval(mu) / hg.eval(mu), 1, 1e-5);
  EXPECT_NEAR(table.mean_cosine(), 0.5f, 1e-5f);
}

TEST(TabulatedPhase, RefusesBadValues) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW(TabulatedPhase(std::vector<float>{1}), std::invalid_argument);
  EXPECT_THROW(TabulatedPhase(std::vector<float>{0, 0, 0}), std::invalid_argument);
  EXPECT_THROW(TabulatedPhase(std::vector<float>{1, -1, 2}), std::invalid_argument);
  EXPECT_THROW(TabulatedPhase(std::vector<float>{1, nan}), std::invalid_argument);
}

}  // namespace
}  // namespace turbid
