// Heterogeneous media: flights, weights, transmittance and emission against closed forms and quadrature.
#include "medium/heterogeneous.h"

#include <gtest/gtest.h>

#include "medium/homogeneous.h"
#include "medium/volumes_for_tests.h"
#include "testing/chi_square.h"

namespace turbid {
namespace {

using testing::constant_volume;
using testing::kWorstZ;
using testing::make_medium;
using testing::Mean;
using testing::row_volume;

Sampler sampler_of(uint64_t seed) {
  Sampler sampler(SamplerKind::kIndependent, seed);
  sampler.start(0, 0);
  return sampler;
}

/// Along x, from before the row.
const Ray kAlong{{-1, 0.1f, 0.2f}, {1, 0, 0}};

/// Colours that vary along x in their own ways, over a length of 2: thin, thick and empty parts.
const std::vector<Spectrum> kColours = {{0.2f, 3, 1}, {0.5f, 2, 0}, {4, 1, 0.1f}, {0, 0, 6}, {0, 0, 0}, {8, 0.5f, 1}};
const std::vector<Spectrum> kAlbedos = {{0.9f, 0.2f, 0.5f}, {0.1f, 1, 0.7f}};
const Spectrum kMix(0.2f, 0.5f, 0.3f);

/// Optical depth of channel c along kAlong up to x, by the midpoint rule.
double optical_depth(const Volume& sigma_t, int c, double x, double from = 0) {
  constexpr int kSteps = 2000;
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double at = from + (x - from) * (i + 0.5) / kSteps;
    sum += static_cast<double>(sigma_t.eval({static_cast<float>(at), 0.1f, 0.2f})[c]);
  }
  return sum * (x - from) / kSteps;
}

// --- A constant grid is a homogeneous medium
// --------------------------------------------------------------------------

testing::ChiSquareResult distances(const HeterogeneousMedium& medium, float t_max, const Spectrum& mix,
                                   const Spectrum& claimed) {
  return testing::chi_square_interval(
      [&](Rng& rng) -> std::optional<double> {
        Sampler sampler = sampler_of(rng.next_u32());
        const Flight flight = medium.sample_flight({Vec3(0, 0.1f, 0.2f), {1, 0, 0}, t_max}, mix, sampler);
        return flight.collides ? std::optional(static_cast<double>(flight.t)) : std::nullopt;
      },
      [&](double t) {
        double sum = 0;
        for (int c = 0; c < kChannels; ++c)
          sum += static_cast<double>(mix[c] * claimed[c]) * std::exp(-static_cast<double>(claimed[c]) * t);
        return sum;
      },
      0, static_cast<double>(t_max));
}

TEST(HeterogeneousMedium, ConstantGridFliesAsAHomogeneousMedium) {
  const std::vector<Spectrum> sigmas = {Spectrum(2.0f), {1, 2, 5}};
  for (const Spectrum& sigma_t : sigmas) {
    const HeterogeneousMedium medium =
        make_medium(row_volume(std::vector<Spectrum>(9, sigma_t), 2), constant_volume(Spectrum(0.5f)));
    const auto result = distances(medium, 1.5f, kMix, sigma_t);
    EXPECT_TRUE(passes(result, 2)) << result.report;
    EXPECT_FALSE(passes(distances(medium, 1.5f, kMix, sigma_t * Spectrum(1, 1.1f, 1)), 100)) << "planted";
  }
}

TEST(HeterogeneousMedium, ConstantGridHasTheWeightsOfAHomogeneousMedium) {
  const Spectrum sigma_t(1, 2, 5), albedo(0.9f, 0.5f, 0.2f);
  const HeterogeneousMedium medium = make_medium(row_volume({sigma_t, sigma_t}, 2), constant_volume(albedo));
  Mean collided, passed;
  Sampler sampler = sampler_of(7);
  for (int n = 0; n < 200000; ++n) {
    const Flight flight = medium.sample_flight({Vec3(0), {1, 0, 0}, 0.7f}, kMix, sampler);
    collided.add(flight.collides ? flight.weight : Spectrum(0.0f));
    passed.add(flight.collides ? Spectrum(0.0f) : flight.weight);
    if (flight.collides)
      for (int c = 0; c < kChannels; ++c) ASSERT_LE(flight.weight[c] * kMix[c], 1.0001f * albedo[c]);
    else
      EXPECT_NEAR(flight.probability, (kMix * exp(sigma_t * -0.7f)).sum(), 1e-6f);
  }
  for (size_t c = 0; c < kChannels; ++c) {
    const double passing = std::exp(-0.7 * static_cast<double>(sigma_t[static_cast<int>(c)]));
    EXPECT_LT(passed.z(c, passing), kWorstZ);
    EXPECT_LT(collided.z(c, static_cast<double>(albedo[static_cast<int>(c)]) * (1 - passing)), kWorstZ);
  }
  EXPECT_LT(medium.transmittance({Vec3(0), {1, 0, 0}, 0.7f}, sampler)[2] - std::exp(-3.5f), 1e-6f)
      << "exact where nothing varies";
}

TEST(HeterogeneousMedium, GreyExtinctionWeighsByTheAlbedo) {
  const auto sigma_t = row_volume({Spectrum(0.1f), Spectrum(4.0f), Spectrum(1.0f)}, 2);
  const HeterogeneousMedium medium = make_medium(sigma_t, row_volume(kAlbedos, 2));
  Sampler sampler = sampler_of(1);
  for (int n = 0; n < 1000; ++n) {
    const Flight flight = medium.sample_flight(kAlong, kMix, sampler);
    const Spectrum expected = flight.collides ? row_volume(kAlbedos, 2)->eval(kAlong.at(flight.t)) : Spectrum(1.0f);
    for (int c = 0; c < kChannels; ++c) EXPECT_NEAR(flight.weight[c], expected[c], 2e-5f);
  }
}

// --- Densities that vary
// ----------------------------------------------------------------------------------------------

TEST(HeterogeneousMedium, LinearDensityHasItsClosedFormTransmittance) {
  // Voxel centres at 0.25 and 1.75: constant, linear, constant; the trapezoids give the optical depth.
  const auto sigma_t = row_volume({Spectrum(1, 0, 3), Spectrum(2, 4, 0)}, 1);
  const HeterogeneousMedium medium = make_medium(sigma_t, constant_volume(Spectrum(0.8f)));
  const double depth[] = {1.5, 2, 1.5};
  Mean ratio, passing;
  Sampler sampler = sampler_of(11);
  for (uint64_t n = 0; n < 100000; ++n) {
    sampler.start(0, n);
    ratio.add(medium.transmittance(kAlong, sampler));
    const Flight flight = medium.sample_flight(kAlong, Spectrum(1 / 3.0f), sampler);
    passing.add(flight.collides ? Spectrum(0.0f) : flight.weight);
  }
  const Spectrum proxy = medium.proxy_transmittance(kAlong);
  for (size_t c = 0; c < kChannels; ++c) {
    EXPECT_LT(ratio.z(c, std::exp(-depth[c])), kWorstZ);
    EXPECT_LT(passing.z(c, std::exp(-depth[c])), kWorstZ);
    EXPECT_GT(ratio.z(c, std::exp(-1.05 * depth[c])), kWorstZ) << "planted";
    EXPECT_NEAR(static_cast<double>(proxy[static_cast<int>(c)]), std::exp(-depth[c]), 0.05);
  }
}

/// Mean weight of the flights that end in each of ten bins along the row and (last) of those that pass.
std::vector<Mean> binned(const HeterogeneousMedium& medium, const Spectrum& mix, int samples) {
  std::vector<Mean> bins(11);
  Sampler sampler = sampler_of(5);
  for (int n = 0; n < samples; ++n) {
    const Flight flight = medium.sample_flight(kAlong, mix, sampler);
    const float x = kAlong.at(flight.t).x;
    const size_t bin = flight.collides ? std::min<size_t>(9, static_cast<size_t>(5 * x)) : 10;
    for (size_t b = 0; b < 11; ++b) bins[b].add(b == bin ? flight.weight : Spectrum(0.0f));
  }
  return bins;
}

double expected_bin(const Volume& sigma_t, const Volume& albedo, int c, size_t bin) {
  if (bin == 10) return std::exp(-optical_depth(sigma_t, c, 2));
  constexpr int kSteps = 400;
  const double low = 0.2 * static_cast<double>(bin);
  double sum = 0, depth = optical_depth(sigma_t, c, low);
  for (int i = 0; i < kSteps; ++i) {
    const Vec3 p(static_cast<float>(low + 0.2 * (i + 0.5) / kSteps), 0.1f, 0.2f);
    const auto sigma = static_cast<double>(sigma_t.eval(p)[c]);
    sum += sigma * static_cast<double>(albedo.eval(p)[c]) * std::exp(-depth - sigma * 0.1 / kSteps);
    depth += sigma * 0.2 / kSteps;
  }
  return sum * 0.2 / kSteps;
}

TEST(HeterogeneousMedium, ChromaticFlightsAreUnbiasedPerChannelAndPlace) {
  for (const GridFilter filter : {GridFilter::kTrilinear, GridFilter::kNearest}) {
    const auto sigma_t = row_volume(kColours, 2, filter), albedo = row_volume(kAlbedos, 2);
    const HeterogeneousMedium medium = make_medium(sigma_t, albedo);
    for (const Spectrum& mix : {kMix, Spectrum(0, 0.5f, 0.5f), Spectrum(1 / 3.0f)}) {
      const std::vector<Mean> bins = binned(medium, mix, 100000);
      for (size_t bin = 0; bin < bins.size(); ++bin)
        for (int c = 0; c < kChannels; ++c) {
          if (mix[c] == 0) continue;  // such a channel is of no interest to who asks, and its weights have heavy tails
          const double expected = expected_bin(*sigma_t, *albedo, c, bin);
          EXPECT_LT(bins[bin].z(static_cast<size_t>(c), expected), kWorstZ)
              << "bin " << bin << " channel " << c << ": " << bins[bin].mean(static_cast<size_t>(c)) << " for "
              << expected;
        }
    }
  }
}

TEST(HeterogeneousMedium, APlantedErrorShowsInTheBins) {
  const auto sigma_t = row_volume(kColours, 2), albedo = row_volume(kAlbedos, 2);
  auto wrong = kColours;
  wrong[2][0] *= 1.15f;
  const std::vector<Mean> bins = binned(make_medium(row_volume(wrong, 2), albedo), kMix, 100000);
  double worst = 0;
  for (size_t bin = 0; bin < bins.size(); ++bin)
    worst = std::max(worst, bins[bin].z(0, expected_bin(*sigma_t, *albedo, 0, bin)));
  EXPECT_GT(worst, kWorstZ);
}

TEST(HeterogeneousMedium, WeightsAreBoundedByAlbedoOverMix) {
  const HeterogeneousMedium medium = make_medium(row_volume(kColours, 2), constant_volume(Spectrum(0.9f)));
  Sampler sampler = sampler_of(3);
  for (int n = 0; n < 50000; ++n) {
    const Flight flight = medium.sample_flight(kAlong, kMix, sampler);
    for (int c = 0; c < kChannels; ++c) ASSERT_LE(flight.weight[c] * kMix[c], flight.collides ? 0.9001f : 1.0001f);
  }
}

TEST(HeterogeneousMedium, TransmittanceIsUnbiasedPerChannel) {
  for (const GridFilter filter : {GridFilter::kTrilinear, GridFilter::kNearest}) {
    const auto sigma_t = row_volume(kColours, 4, filter);
    const HeterogeneousMedium medium = make_medium(sigma_t, constant_volume(Spectrum(0.0f)));
    for (const float t_max : {0.5f, 2.7f, 3.9f, kInfinity}) {
      Mean ratio;
      Sampler sampler = sampler_of(2);
      for (uint64_t n = 0; n < 50000; ++n) {
        sampler.start(0, n);
        ratio.add(medium.transmittance({kAlong.origin, kAlong.direction, t_max}, sampler));
      }
      const double end = std::clamp(static_cast<double>(t_max) - 1, 0.0, 4.0);
      for (int c = 0; c < kChannels; ++c)
        EXPECT_LT(ratio.z(static_cast<size_t>(c), std::exp(-optical_depth(*sigma_t, c, end))), kWorstZ) << t_max;
    }
  }
}

TEST(HeterogeneousMedium, TheProxyIsAFunctionOfTheRayAndNeverZero) {
  const HeterogeneousMedium medium =
      make_medium(row_volume({Spectrum(1e5f), Spectrum(0.0f, 1, 1e3f)}, 2), constant_volume(Spectrum(0.0f)));
  const Spectrum proxy = medium.proxy_transmittance(kAlong);
  EXPECT_EQ(proxy, medium.proxy_transmittance(kAlong));
  EXPECT_GT(proxy.min(), 0);
  EXPECT_EQ(medium.proxy_transmittance({{-1, 5, 0}, {1, 0, 0}}), Spectrum(1.0f)) << "passes beside";
}

TEST(HeterogeneousMedium, BesideItsBoundsThereIsNothing) {
  const HeterogeneousMedium medium = make_medium(constant_volume(Spectrum(100.0f)), constant_volume(Spectrum(1.0f)));
  Sampler sampler = sampler_of(1);
  for (const Ray& ray : {Ray{{2, 0, 0}, {1, 0, 0}}, Ray{{-1, 0.5f, 0.5f}, {1, 0, 0}, 0.9f}}) {
    const Flight flight = medium.sample_flight(ray, kMix, sampler);
    EXPECT_FALSE(flight.collides);
    EXPECT_NEAR(flight.weight[0], 1, 1e-6f);
    EXPECT_EQ(medium.transmittance(ray, sampler), Spectrum(1.0f));
  }
  const Flight inside = medium.sample_flight({{-5, 0.5f, 0.5f}, {1, 0, 0}}, kMix, sampler);
  EXPECT_TRUE(inside.collides);
  EXPECT_GE(inside.t, 5);
}

TEST(HeterogeneousMedium, StaysFiniteInExtremes) {
  Sampler sampler = sampler_of(4);
  for (const float scale : {1e-30f, 1e-6f, 1.0f, 1e4f, 1e15f})
    for (const Spectrum& shape : {Spectrum(1.0f), Spectrum(0, 1, 1e-3f), Spectrum(1, 1e6f, 1e-6f)})
      for (const Spectrum& mix : {Spectrum(1 / 3.0f), Spectrum(0, 1, 0), Spectrum(1, 0, 0), Spectrum(1e-6f, 0, 1)})
        for (uint64_t n = 0; n < 20; ++n) {
          sampler.start(0, n);
          const HeterogeneousMedium medium =
              make_medium(row_volume({shape * scale, shape * (scale * 0.99f)}, 2), constant_volume(Spectrum(0.5f)));
          // Long enough for many collisions, short enough for the test.
          const float t_max = 1 + std::min(1.0f, 500 / (scale * 1e6f));
          const Flight flight = medium.sample_flight({kAlong.origin, kAlong.direction, t_max}, mix, sampler);
          ASSERT_TRUE(flight.weight.is_finite()) << scale;
          ASSERT_GE(flight.weight.min(), 0);
          ASSERT_TRUE(medium.transmittance({kAlong.origin, kAlong.direction, t_max}, sampler).is_finite());
        }
}

// --- Emission
// ---------------------------------------------------------------------------------------------------------

Mean emission_along(const HeterogeneousMedium& medium, const Spectrum& mix, int samples = 100000) {
  Mean mean;
  Sampler sampler = sampler_of(6);
  for (int n = 0; n < samples; ++n) mean.add(medium.sample_flight(kAlong, mix, sampler).emission);
  return mean;
}

TEST(HeterogeneousMedium, UniformEmissionHasItsClosedForm) {
  // Per unit length: emission (1 - exp(-sigma_t d)) / sigma_t; of absorbing matter: Le sigma_a times the same.
  const Spectrum sigma_t(0.5f, 2, 6), emission(3, 1, 2), albedo(0, 0.5f, 0.9f);
  const auto density = row_volume({sigma_t, sigma_t, sigma_t}, 2);
  for (const bool by_absorption : {false, true}) {
    const HeterogeneousMedium medium =
        make_medium(density, constant_volume(albedo), constant_volume(emission), by_absorption);
    EXPECT_TRUE(medium.emits());
    const Mean mean = emission_along(medium, kMix);
    for (int c = 0; c < kChannels; ++c) {
      const auto sigma = static_cast<double>(sigma_t[c]);
      const double source = static_cast<double>(emission[c] * (by_absorption ? sigma_t[c] * (1 - albedo[c]) : 1));
      const double expected = source * (1 - std::exp(-2 * sigma)) / sigma;
      EXPECT_LT(mean.z(static_cast<size_t>(c), expected), kWorstZ) << mean.mean(static_cast<size_t>(c));
      EXPECT_GT(mean.z(static_cast<size_t>(c), 1.05 * expected), kWorstZ) << "planted";
    }
  }
}

TEST(HeterogeneousMedium, EmptySpaceCanShine) {
  const HeterogeneousMedium medium =
      make_medium(row_volume({Spectrum(0.0f)}, 2), constant_volume(Spectrum(0.0f)), constant_volume({1, 2, 3}));
  const Mean mean = emission_along(medium, kMix);
  for (size_t c = 0; c < kChannels; ++c) EXPECT_LT(mean.z(c, 2.0 * static_cast<double>(c + 1)), kWorstZ);
}

TEST(HeterogeneousMedium, VaryingEmissionInAVaryingMediumIsUnbiased) {
  const auto sigma_t = row_volume(kColours, 2), emission = row_volume({{1, 0, 2}, {0, 5, 2}, {3, 0, 0}}, 2);
  const Mean mean = emission_along(make_medium(sigma_t, constant_volume(Spectrum(0.3f)), emission), kMix);
  constexpr int kSteps = 4000;
  for (int c = 0; c < kChannels; ++c) {
    double sum = 0, depth = 0;
    for (int i = 0; i < kSteps; ++i) {
      const Vec3 p(2 * (static_cast<float>(i) + 0.5f) / kSteps, 0.1f, 0.2f);
      const double step = 2.0 / kSteps, sigma = static_cast<double>(sigma_t->eval(p)[c]);
      sum += static_cast<double>(emission->eval(p)[c]) * std::exp(-depth - sigma * step / 2) * step;
      depth += sigma * step;
    }
    EXPECT_LT(mean.z(static_cast<size_t>(c), sum), kWorstZ) << mean.mean(static_cast<size_t>(c)) << " for " << sum;
  }
}

// --- What it is made of
// -----------------------------------------------------------------------------------------------

TEST(HeterogeneousMedium, ReportsItsAverages) {
  const HeterogeneousMedium medium = make_medium(
      row_volume({Spectrum(1.0f), Spectrum(3, 5, 7)}, 2, GridFilter::kNearest), constant_volume(Spectrum(0.5f)));
  EXPECT_EQ(medium.sigma_t(), Spectrum(2, 3, 4));
  EXPECT_EQ(medium.sigma_s(), Spectrum(1, 1.5f, 2));
  EXPECT_EQ(medium.max_sigma_t(), 7);
  EXPECT_EQ(medium.as_homogeneous(), nullptr);
  EXPECT_FALSE(medium.emits());
}

TEST(HeterogeneousMedium, RefusesWhatMakesNoSense) {
  const auto one = constant_volume(Spectrum(1.0f));
  const auto flat = constant_volume(Spectrum(1.0f), Transform::translate(1, 2, 3));
  EXPECT_THROW(make_medium(nullptr, one), std::invalid_argument);
  EXPECT_THROW(make_medium(one, nullptr), std::invalid_argument);
  EXPECT_THROW(make_medium(constant_volume(Spectrum(1, -1, 1)), one), std::invalid_argument);
  EXPECT_THROW(make_medium(one, constant_volume(Spectrum(1, 1.1f, 1))), std::invalid_argument);
  EXPECT_THROW(make_medium(one, one, constant_volume(Spectrum(-1.0f))), std::invalid_argument);
  EXPECT_THROW(HeterogeneousMedium({.sigma_t = one, .albedo = one, .phase = nullptr}), std::invalid_argument);
  EXPECT_THROW(
      HeterogeneousMedium({.sigma_t = one, .albedo = one, .scale = -1, .phase = std::make_shared<IsotropicPhase>()}),
      std::invalid_argument);
  EXPECT_THROW(HeterogeneousMedium({.sigma_t = constant_volume(Spectrum(1e38f)),
                                    .albedo = one,
                                    .scale = 1e38f,
                                    .phase = std::make_shared<IsotropicPhase>()}),
               std::invalid_argument);
}

}  // namespace
}  // namespace turbid
