// Phase functions with formulas of their own: halves of Henyey-Greenstein, two terms, and Draine.
#include <gtest/gtest.h>

#include "core/rng.h"
#include "core/vector.h"
#include "medium/draine.h"
#include "medium/half_henyey_greenstein.h"
#include "medium/henyey_greenstein.h"
#include "medium/phases_for_tests.h"
#include "medium/rayleigh.h"
#include "medium/two_term_henyey_greenstein.h"

namespace turbid {
namespace {

using testing::moment;
using testing::test_samples;
using Half = HalfHenyeyGreensteinPhase;
using enum HalfHenyeyGreensteinPhase::Hemisphere;

const float kNan = std::numeric_limits<float>::quiet_NaN();

TEST(HalfHenyeyGreenstein, IsTheNormalisedPartOfTheWhole) {
  for (const float g : {-0.95f, -0.3f, -1e-4f, 0.0f, 1e-5f, 1e-3f, 0.5f, 0.99f}) {
    const HenyeyGreensteinPhase whole(g);
    // P(mu > 0) = (1 - g^2) / (2 g) (1 / (1 - g) - 1 / sqrt(1 + g^2)), in long double; 1/2 at 0
    const long double gl = g;
    const double forward =
        g == 0 ? 0.5 : static_cast<double>((1 - gl * gl) / (2 * gl) * (1 / (1 - gl) - 1 / std::sqrt(1 + gl * gl)));
    for (const float m : {1e-3f, 0.3f, 0.9f, 1.0f}) {
      const auto part = [&](float mu) { return static_cast<double>(whole.eval(mu)); };
      EXPECT_NEAR(static_cast<double>(Half(g, kForward).eval(m)) * forward / part(m), 1, 2e-6) << g;
      EXPECT_NEAR(static_cast<double>(Half(g, kBackward).eval(-m)) * (1 - forward) / part(-m), 1, 1e-5) << g;
      EXPECT_EQ(Half(g, kForward).eval(-m), 0);
      EXPECT_EQ(Half(g, kBackward).eval(m), 0);
    }
  }
}

TEST(HalfHenyeyGreenstein, BackwardMirrorsForwardOfTheOppositeSign) {
  for (const float g : {-0.7f, 0.2f, 0.9f})
    for (const float u : {0.0f, 0.25f, 0.75f})
      EXPECT_NEAR(Half(g, kBackward).sample(u), -Half(-g, kForward).sample(1 - u), 1e-6f);
}

TEST(HalfHenyeyGreenstein, InvertsItsCdf) {
  // y = (1 + g^2 - 2 g mu)^(-1/2) is uniform in [a, b].
  for (const double g : {-0.9, -0.4, 0.3, 0.9, 0.99})
    for (const double u : {0.0, 1e-3, 0.3, 0.9, 0.999}) {
      const auto mu = static_cast<double>(Half(static_cast<float>(g), kForward).sample(static_cast<float>(u)));
      const double a = 1 / std::sqrt(1 + g * g), b = 1 / (1 - g), squared = 1 + g * g - 2 * g * mu;
      const double slope = g / (b - a) / (squared * std::sqrt(squared));
      EXPECT_NEAR((1 / std::sqrt(squared) - a) / (b - a), u, 1e-6 + 1.2e-7 * slope) << g;
    }
}

TEST(HalfHenyeyGreenstein, IsUniformInItsHemisphereAtZero) {
  for (const float u : {0.0f, 0.5f, 0.875f}) {
    EXPECT_EQ(Half(0, kForward).sample(u), u);
    EXPECT_EQ(Half(0, kBackward).sample(u), u - 1);
  }
  EXPECT_FLOAT_EQ(Half(0, kForward).eval(0.5f), kInvPi / 2);
}

TEST(HalfHenyeyGreenstein, PlantedErrorsAreFound) {
  EXPECT_FALSE(passes(test_samples(Half(0.5f, kForward), Half(0.53f, kForward)), 100));
  EXPECT_FALSE(passes(test_samples(Half(0.5f, kBackward), Half(-0.5f, kBackward)), 100)) << "mirrored with the same g";
  EXPECT_FALSE(passes(test_samples(Half(0.5f, kForward), HenyeyGreensteinPhase(0.5f)), 100));
}

TEST(HalfHenyeyGreenstein, RefusesImpossibleValues) {
  for (const float g : {1.0f, -1.0f, kNan}) EXPECT_THROW(Half(g, kForward), std::invalid_argument) << g;
}

TEST(TwoTermHenyeyGreenstein, WeighsTheFirstTerm) {
  const TwoTermHenyeyGreensteinPhase phase({.w = 0.75f, .g1 = 0.9f, .g2 = -0.4f});
  const HenyeyGreensteinPhase first(0.9f), second(-0.4f);
  for (const float mu : {-1.0f, 0.2f, 1.0f})
    EXPECT_FLOAT_EQ(phase.eval(mu), 0.75f * first.eval(mu) + 0.25f * second.eval(mu));
  EXPECT_FLOAT_EQ(phase.mean_cosine(), 0.75f * 0.9f - 0.25f * 0.4f);
  EXPECT_FALSE(passes(test_samples(phase, TwoTermHenyeyGreensteinPhase({.w = 0.25f, .g1 = 0.9f, .g2 = -0.4f})), 100))
      << "weight of the second term";
}

TEST(TwoTermHenyeyGreenstein, KnowsTheFitsOfThePaper) {
  EXPECT_EQ(two_term_presets(), (std::vector<std::string>{"ocean_water", "water_droplets"}));
  EXPECT_NEAR(TwoTermHenyeyGreensteinPhase(two_term_preset("ocean_water")).mean_cosine(), 0.9726f, 1e-4f);
  EXPECT_NEAR(TwoTermHenyeyGreensteinPhase(two_term_preset("water_droplets")).mean_cosine(), 0.5787f, 1e-4f);
  EXPECT_THROW(two_term_preset("milk"), std::invalid_argument);
}

TEST(TwoTermHenyeyGreenstein, RefusesImpossibleValues) {
  using Terms = TwoTermHenyeyGreensteinPhase::Terms;
  for (const Terms& terms : {Terms{-0.1f, 0, 0}, Terms{1.1f, 0, 0}, Terms{kNan, 0, 0}, Terms{0.5f, 1, 0},
                             Terms{0.5f, 0, -1}, Terms{0.5f, kNan, 0}})
    EXPECT_THROW(TwoTermHenyeyGreensteinPhase{terms}, std::invalid_argument);
}

TEST(Draine, ContainsHenyeyGreensteinAndRayleigh) {
  for (const float mu : {-1.0f, -0.3f, 0.0f, 0.8f, 1.0f}) {
    EXPECT_FLOAT_EQ(DrainePhase(0.6f, 0).eval(mu), HenyeyGreensteinPhase(0.6f).eval(mu));
    EXPECT_NEAR(DrainePhase(0, 1).eval(mu), RayleighPhase().eval(mu), 1e-7f);
    // Cornette & Shanks 1992: 3/2 (1 - g^2) / (2 + g^2) (1 + mu^2) / (1 + g^2 - 2 g mu)^(3/2) / (4 pi)
    const float g = 0.7f, squared = 1 + g * g - 2 * g * mu;
    const float shanks = 1.5f * (1 - g * g) / (2 + g * g) * (1 + mu * mu) / (squared * std::sqrt(squared)) / (4 * kPi);
    EXPECT_NEAR(DrainePhase(g, 1).eval(mu) / shanks, 1, 2e-6f) << mu;
  }
  for (const float u : {0.0f, 0.1f, 0.5f, 0.99f})
    EXPECT_NEAR(DrainePhase(0, 1).sample(u), RayleighPhase().sample(u), 1e-6f);
}

TEST(Draine, InvertsItsCdf) {
  for (const auto& [g, alpha] :
       {std::pair{-0.9f, 1.0f}, {-0.3f, 250.0f}, {0.0f, 250.0f}, {1e-4f, 5.0f}, {0.6f, 30.0f}, {0.99f, 1e4f}}) {
    const DrainePhase phase(g, alpha);
    for (const float u : {0.0f, 1e-4f, 0.2f, 0.5f, 0.9f, 0.9999f}) {
      const auto end = static_cast<double>(phase.sample(g < 0 ? 1 - u : u));
      const double part = testing::integrate_interval(
          [&](double mu) { return 2 * std::numbers::pi * static_cast<double>(phase.eval(static_cast<float>(mu))); }, -1,
          end, 1e-7, 5, 16);
      // Next to a peak half a step of mu, 3e-8, is a part of the CDF.
      const double slope = 2 * std::numbers::pi * static_cast<double>(phase.eval(static_cast<float>(end)));
      EXPECT_NEAR(part, static_cast<double>(u), 5e-6 + 1.2e-7 * slope) << g << ' ' << alpha;
    }
  }
}

TEST(Draine, PlantedErrorsAreFound) {
  EXPECT_FALSE(passes(test_samples(DrainePhase(0.55f, 22), DrainePhase(0.55f, 12)), 100));
  EXPECT_FALSE(passes(test_samples(DrainePhase(0.55f, 22), DrainePhase(0.54f, 22)), 100));
}

TEST(Draine, RefusesImpossibleValues) {
  EXPECT_THROW(DrainePhase(1, 1), std::invalid_argument);
  EXPECT_THROW(DrainePhase(kNan, 1), std::invalid_argument);
  for (const float alpha : {-0.5f, kNan, kInfinity})
    EXPECT_THROW(DrainePhase(0, alpha), std::invalid_argument) << alpha;
}

}  // namespace
}  // namespace turbid
