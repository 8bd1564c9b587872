// Homogeneous media: flights follow the mixture of the channels, and their weights have the closed-form expectations.
#include "medium/homogeneous.h"

#include <gtest/gtest.h>

#include "medium/isotropic.h"
#include "testing/chi_square.h"

namespace turbid {
namespace {

const auto kPhase = std::make_shared<IsotropicPhase>();

HomogeneousMedium medium(const Spectrum& sigma_t, const Spectrum& albedo) {
  return {sigma_t, sigma_t * albedo, kPhase};
}

struct Case {
  const char* name;
  Spectrum sigma_t, albedo, mix;
  float t_max;
};

const Case kCases[] = {
    {"chromatic", {1, 2, 5}, {0.9f, 0.5f, 0.2f}, {0.2f, 0.5f, 0.3f}, 0.7f},
    {"very chromatic", {0.01f, 1, 100}, {0.99f, 1, 0.1f}, {1 / 3.0f, 1 / 3.0f, 1 / 3.0f}, 2},
    {"one clear channel", {0, 3, 1}, {0, 0.8f, 0.4f}, {0.25f, 0.25f, 0.5f}, 1.5f},
    {"unused channel", {1, 2, 3}, {0.7f, 0.8f, 0.9f}, {0, 0.4f, 0.6f}, 0.5f},
    {"picks by the last channel", {0.5f, 2, 3}, {0.7f, 0.8f, 0.9f}, {0, 0, 1}, 0.5f},
    {"picks by the first channel", {0.5f, 2, 3}, {0.7f, 0.8f, 0.9f}, {1, 0, 0}, 0.5f},
    {"grey extinction, coloured albedo", {2, 2, 2}, {0.9f, 0.5f, 0.2f}, {0.2f, 0.5f, 0.3f}, 0.7f},
    {"opaque", {50, 80, 90}, {0.9f, 0.5f, 0.2f}, {0.3f, 0.3f, 0.4f}, 10},
};

double mixture_density(const Case& c, double t) {
  double sum = 0;
  for (int i = 0; i < kChannels; ++i) {
    const auto sigma = static_cast<double>(c.sigma_t[i]);
    sum += static_cast<double>(c.mix[i]) * sigma * std::exp(-sigma * t);
  }
  return sum;
}

testing::ChiSquareResult test_distances(const Case& c, const Case& claimed) {
  const HomogeneousMedium m = medium(c.sigma_t, c.albedo);
  return testing::chi_square_interval(
      [&](Rng& rng) -> std::optional<double> {
        const Flight flight = m.flight(c.t_max, c.mix, rng.next_float());
        return flight.collides ? std::optional(static_cast<double>(flight.t)) : std::nullopt;
      },
      [&](double t) { return mixture_density(claimed, t); }, 0, static_cast<double>(c.t_max));
}

TEST(HomogeneousMedium, DistancesFollowTheMixture) {
  for (const Case& c : kCases) {
    const auto result = test_distances(c, c);
    EXPECT_TRUE(passes(result, static_cast<int>(std::size(kCases)))) << c.name << ": " << result.report;
  }
}

TEST(HomogeneousMedium, PlantedErrorsAreFound) {
  Case wrong = kCases[0];
  wrong.mix = {0.3f, 0.4f, 0.3f};
  EXPECT_FALSE(passes(test_distances(kCases[0], wrong), 100)) << "wrong mixture";
  wrong = kCases[0];
  wrong.sigma_t = {1, 2.5f, 5};
  EXPECT_FALSE(passes(test_distances(kCases[0], wrong), 100)) << "wrong extinction";
}

struct Expectation {
  double collided[kChannels] = {}, passed[kChannels] = {}, distance[kChannels] = {};
  double collisions = 0;
};

/// Averages over u on a fine lattice: no noise, an error of the order of its spacing.
Expectation expectation(const HomogeneousMedium& m, float t_max, const Spectrum& mix) {
  constexpr int kCount = 1 << 20;
  Expectation e;
  for (int i = 0; i < kCount; ++i) {
    const Flight flight = m.flight(t_max, mix, (static_cast<float>(i) + 0.5f) / kCount);
    for (int c = 0; c < kChannels; ++c) {
      const double weight = static_cast<double>(flight.weight[c]) / kCount;
      (flight.collides ? e.collided : e.passed)[c] += weight;
      if (flight.collides) e.distance[c] += weight * static_cast<double>(flight.t);
    }
    if (flight.collides) e.collisions += 1.0 / kCount;
  }
  return e;
}

TEST(HomogeneousMedium, WeightsHaveTheirClosedFormExpectations) {
  for (const Case& c : kCases) {
    const Expectation e = expectation(medium(c.sigma_t, c.albedo), c.t_max, c.mix);
    for (int i = 0; i < kChannels; ++i) {
      const double sigma = static_cast<double>(c.sigma_t[i]), d = static_cast<double>(c.t_max);
      const double passing = std::exp(-sigma * d), albedo = static_cast<double>(c.albedo[i]);
      // A channel's weight varies where another channel picks the distance: the lattice's error grows with the weight.
      const double tolerance = c.mix[i] > 0 ? 1e-5 : 1e-3;
      EXPECT_NEAR(e.collided[i], albedo * (1 - passing), tolerance) << c.name << ' ' << i;
      EXPECT_NEAR(e.passed[i], passing, tolerance) << c.name << ' ' << i;
      const double mean = sigma > 0 ? albedo * (1 - (1 + sigma * d) * passing) / sigma : 0;
      EXPECT_NEAR(e.distance[i], mean, tolerance * std::max(1.0, d)) << c.name << ' ' << i;
    }
  }
}

TEST(HomogeneousMedium, InAnInfiniteMediumEveryFlightCollides) {
  const HomogeneousMedium m = medium({0.5f, 1, 4}, {0.9f, 0.8f, 0.7f});
  const Spectrum mix(0.2f, 0.3f, 0.5f);
  const Expectation e = expectation(m, kInfinity, mix);
  EXPECT_NEAR(e.collisions, 1, 1e-9);
  for (int c = 0; c < kChannels; ++c) {
    EXPECT_NEAR(e.collided[c], static_cast<double>(m.albedo()[c]), 1e-4);
    EXPECT_NEAR(e.distance[c], static_cast<double>(m.albedo()[c] / m.sigma_t()[c]), 2e-4);
  }
}

TEST(HomogeneousMedium, PassingReportsItsProbability) {
  for (const Case& c : kCases) {
    const HomogeneousMedium m = medium(c.sigma_t, c.albedo);
    const double probability = static_cast<double>((c.mix * m.transmittance(c.t_max)).sum());
    EXPECT_NEAR(1 - expectation(m, c.t_max, c.mix).collisions, probability, 3e-6) << c.name;
    for (int i = 0; i < 1000; ++i) {
      const Flight flight = m.flight(c.t_max, c.mix, static_cast<float>(i) / 1000);
      if (flight.collides) continue;
      EXPECT_FLOAT_EQ(flight.probability, static_cast<float>(probability)) << c.name;
    }
  }
}

TEST(HomogeneousMedium, WeightsAreBoundedByAlbedoOverMix) {
  // The point of dividing by the whole mixture: no channel is divided by the small density of another alone.
  for (const Case& c : kCases) {
    const HomogeneousMedium m = medium(c.sigma_t, c.albedo);
    for (int k = 0; k < 10000; ++k) {
      const Flight flight = m.flight(c.t_max, c.mix, static_cast<float>(k) / 10000);
      if (!flight.collides) continue;
      for (int i = 0; i < kChannels; ++i) EXPECT_LE(flight.weight[i] * c.mix[i], 1.0001f * c.albedo[i]) << c.name;
    }
  }
}

TEST(HomogeneousMedium, GreyMediaWeighByTheAlbedo) {
  const HomogeneousMedium m = medium(Spectrum(3.0f), {0.9f, 0.5f, 0.2f});
  EXPECT_TRUE(m.is_grey());
  const Flight collided = m.flight(1, Spectrum(1 / 3.0f), 0.5f);
  EXPECT_TRUE(collided.collides);
  EXPECT_FLOAT_EQ(collided.t, std::log(2.0f) / 3);
  EXPECT_EQ(collided.weight, m.albedo());
  const Flight passed = m.flight(1, Spectrum(1 / 3.0f), 0.99f);
  EXPECT_FALSE(passed.collides);
  EXPECT_EQ(passed.weight, Spectrum(1.0f));
  EXPECT_FLOAT_EQ(passed.probability, std::exp(-3.0f));
}

TEST(HomogeneousMedium, WithoutExtinctionEverythingPasses) {
  const HomogeneousMedium m = medium(Spectrum(), Spectrum());
  for (const float t_max : {1.0f, kInfinity})
    for (const float u : {0.0f, 0.5f, kOneMinusEpsilon}) {
      const Flight flight = m.flight(t_max, Spectrum(1 / 3.0f), u);
      EXPECT_FALSE(flight.collides);
      EXPECT_EQ(flight.weight, Spectrum(1.0f));
      EXPECT_EQ(flight.probability, 1);
    }
  EXPECT_EQ(m.transmittance(kInfinity), Spectrum(1.0f));
}

TEST(HomogeneousMedium, StaysFiniteInExtremes) {
  const Spectrum third(1 / 3.0f);  // sums to a little more or less than 1
  for (const float scale : {1e-20f, 1e-6f, 1.0f, 1e6f, 1e20f})
    for (const Spectrum& shape :
         {Spectrum(1, 1, 1), Spectrum(0, 1, 1e-3f), Spectrum(1, 0, 0), Spectrum(1, 1e6f, 1e-6f)})
      for (const Spectrum& mix : {third, Spectrum(0, 1, 0), Spectrum(1e-6f, 1e-6f, 1 - 2e-6f), Spectrum(0.5f, 0.5f, 0)})
        for (const float t_max : {1e-30f, 1e-3f, 1e3f, 1e30f, kInfinity})
          for (const float u : {0.0f, 0x1p-24f, 0.33333334f, 0.5f, 0.6666667f, kOneMinusEpsilon}) {
            const Flight flight = medium(shape * scale, Spectrum(0.5f)).flight(t_max, mix, u);
            ASSERT_TRUE(flight.weight.is_finite()) << scale << ' ' << t_max << ' ' << u;
            ASSERT_GE(flight.weight.min(), 0);
            ASSERT_TRUE(flight.t >= 0 && flight.t <= std::numeric_limits<float>::max());
            ASSERT_TRUE(flight.probability > 0 || flight.collides);
          }
}

TEST(HomogeneousMedium, TakesOneNumberOfTheSampler) {
  const HomogeneousMedium m = medium({1, 2, 5}, Spectrum(0.5f));
  Sampler used(SamplerKind::kIndependent, 7), twin(SamplerKind::kIndependent, 7);
  used.start(3, 4), twin.start(3, 4);
  const Spectrum mix(0.2f, 0.3f, 0.5f);
  const Flight flight = m.sample_flight(Ray{Vec3(0), Vec3(0, 0, 1), 2.0f}, mix, used);
  const Flight same = m.flight(2.0f, mix, twin.next_1d());
  EXPECT_EQ(flight.collides, same.collides);
  EXPECT_EQ(flight.weight, same.weight);
  EXPECT_EQ(used.next_1d(), twin.next_1d());
}

TEST(HomogeneousMedium, RefusesImpossibleCoefficients) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW(HomogeneousMedium(Spectrum(-1, 1, 1), Spectrum(), kPhase), std::invalid_argument);
  EXPECT_THROW(HomogeneousMedium(Spectrum(1.0f), Spectrum(0, 2, 0), kPhase), std::invalid_argument);
  EXPECT_THROW(HomogeneousMedium(Spectrum(nan, 1, 1), Spectrum(), kPhase), std::invalid_argument);
  EXPECT_THROW(HomogeneousMedium(Spectrum(kInfinity), Spectrum(), kPhase), std::invalid_argument);
}

}  // namespace
}  // namespace turbid
