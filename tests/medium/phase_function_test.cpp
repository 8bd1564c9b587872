// Phase functions: each is a density over the sphere, is sampled as it says, and has the mean cosine that it says.
#include "medium/phase_function.h"

#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "medium/blend_phase.h"
#include "medium/henyey_greenstein.h"
#include "medium/isotropic.h"
#include "medium/rayleigh.h"
#include "medium/tabulated_phase.h"
#include "testing/chi_square.h"

namespace turbid {
namespace {

using testing::chi_square_interval;
using testing::integrate_interval;

constexpr double kTwoPi = 2 * std::numbers::pi;

/// 2 pi int weight(mu) f(mu) dmu, with the two ends refined, where peaks stand.
double moment(const PhaseFunction& phase, const std::function<double(double)>& weight) {
  const auto integrand = [&](double mu) {
    return kTwoPi * weight(mu) * static_cast<double>(phase.eval(static_cast<float>(mu)));
  };
  double sum = 0;
  double inner = 0;
  for (double outer = 1; outer > 1e-9; outer = inner == 0 ? 0 : inner) {
    inner = outer > 1e-6 ? outer / 4 : 0;
    sum += integrate_interval(integrand, 1 - outer, 1 - inner, 1e-8, 3, 10);
    sum += integrate_interval(integrand, -1 + inner, -1 + outer, 1e-8, 3, 10);
    if (inner == 0) break;
  }
  return sum;
}

testing::ChiSquareResult test_samples(const PhaseFunction& sampled, const PhaseFunction& claimed) {
  return chi_square_interval(
      [&](Rng& rng) -> std::optional<double> { return static_cast<double>(sampled.sample(rng.next_float())); },
      [&](double mu) { return kTwoPi * static_cast<double>(claimed.eval(static_cast<float>(mu))); }, -1, 1);
}

struct Named {
  std::string name;
  std::shared_ptr<const PhaseFunction> phase;
};

std::vector<Named> all_phase_functions() {
  std::vector<Named> result{{"isotropic", std::make_shared<IsotropicPhase>()},
                            {"rayleigh", std::make_shared<RayleighPhase>()}};
  for (const float g : {-0.99f, -0.9f, -0.5f, -1e-3f, -1e-6f, 0.0f, 1e-7f, 1e-4f, 0.01f, 0.3f, 0.7f, 0.9f, 0.99f})
    result.push_back({"hg " + std::to_string(g), std::make_shared<HenyeyGreensteinPhase>(g)});
  result.push_back({"blend", std::make_shared<BlendPhase>(std::make_shared<HenyeyGreensteinPhase>(0.8f),
                                                          std::make_shared<HenyeyGreensteinPhase>(-0.3f), 0.25f)});
  result.push_back({"table of 2", std::make_shared<TabulatedPhase>(std::array{0.0f, 3.0f})});
  result.push_back({"table", std::make_shared<TabulatedPhase>(std::array{2.0f, 0.5f, 0.0f, 0.0f, 1.0f, 6.0f})});
  return result;
}

TEST(PhaseFunction, IntegratesToOne) {
  for (const auto& [name, phase] : all_phase_functions())
    EXPECT_NEAR(moment(*phase, [](double) { return 1.0; }), 1, 2e-5) << name;
}

TEST(PhaseFunction, HasTheMeanCosineItClaims) {
  for (const auto& [name, phase] : all_phase_functions())
    EXPECT_NEAR(moment(*phase, [](double mu) { return mu; }), static_cast<double>(phase->mean_cosine()), 2e-5) << name;
}

TEST(PhaseFunction, IsSampledAsItSays) {
  const auto all = all_phase_functions();
  for (const auto& [name, phase] : all) {
    const auto result = test_samples(*phase, *phase);
    EXPECT_TRUE(passes(result, static_cast<int>(all.size()))) << name << ": " << result.report;
  }
}

TEST(PhaseFunction, PlantedErrorsAreFound) {
  const HenyeyGreensteinPhase right(0.5f), wrong(0.52f), mirrored(-0.5f);
  EXPECT_FALSE(passes(test_samples(right, wrong), 100)) << "slightly wrong g";
  EXPECT_FALSE(passes(test_samples(right, mirrored), 100)) << "wrong sign convention";
  EXPECT_FALSE(passes(test_samples(RayleighPhase(), IsotropicPhase()), 100));
}

TEST(PhaseFunction, SamplesStayInRangeAndGrowWithU) {
  for (const auto& [name, phase] : all_phase_functions()) {
    if (name == "blend") continue;  // grows within each half only
    float last = -1;
    for (int i = 0; i <= 1000; ++i) {
      const float mu = phase->sample(std::min(static_cast<float>(i) / 1000, kOneMinusEpsilon));
      ASSERT_GE(mu, -1) << name;
      ASSERT_LE(mu, 1) << name;
      if (name.starts_with("hg -")) continue;  // falls with u: the formula is mirrored
      ASSERT_GE(mu, last - 1e-6f) << name << " at " << i;
      last = mu;
    }
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
