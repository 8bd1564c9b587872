#include "table/multiple_scattering.h"

#include <gtest/gtest.h>

#include "core/frame.h"
#include "medium/henyey_greenstein.h"
#include "table/tables_for_tests.h"

namespace turbid::testing {
namespace {

HomogeneousMedium medium(const Spectrum& sigma_t, float albedo, float g) {
  return {sigma_t, sigma_t * albedo, std::make_shared<HenyeyGreensteinPhase>(g)};
}

Vec3 direction(Rng& rng) {
  const float u = rng.next_float();
  return square_to_sphere({u, rng.next_float()});
}

/// Light of a stretch by the collisions along it, with the stretch's own transmittance: as it is defined.
float by_collisions(const MultipleScattering& light, const Stretch& stretch, float sigma_t, const Vec3& x,
                    const Vec3& w) {
  constexpr int kSteps = 400;
  const float length = std::min(stretch.length, 20 / sigma_t);
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) {
    // Even in the probability to have collided.
    const float passed = 1 - (1 - std::exp(-sigma_t * length)) * (static_cast<float>(i) + 0.5f) / kSteps;
    const Vec3 at = stretch.origin - stretch.direction * (std::log(passed) / sigma_t);
    sum += static_cast<double>(light.source_radiance(at, stretch.direction, x, w)[0]);
  }
  return static_cast<float>(sum / kSteps) * (1 - std::exp(-sigma_t * length));
}

/// Mean deviation of a stretch's light from that of its collisions, relative to the mean; per channel 0.
double stretch_error(float g, float albedo, float depth, float told_depth, double* bias) {
  const float sigma_t = 2;
  const MultipleScattering light(medium(Spectrum(sigma_t), albedo, g), small_table(g));
  const Stretch stretch{{1, 2, 3}, normalize(Vec3(1, -2, 0.5f)), depth / sigma_t};
  Stretch told = stretch;
  told.length = told_depth / sigma_t;
  Rng rng(11);
  double deviation = 0, difference = 0, sum = 0;
  for (int i = 0; i < 400; ++i) {
    // Distances from 0.5 to 10 mean free paths off the stretch.
    const float away = 0.5f * std::exp(3 * rng.next_float()) / sigma_t;
    const Vec3 x = stretch.origin + stretch.direction * (std::min(depth, 2.0f) / sigma_t * rng.next_float()) +
                   direction(rng) * away;
    const Vec3 w = direction(rng);
    const double expected = static_cast<double>(by_collisions(light, told, sigma_t, x, w)) * sqr(double{away});
    const double found = static_cast<double>(light.source_radiance(stretch, x, w)[0]) * sqr(double{away});
    deviation += std::abs(found - expected);
    difference += found - expected;
    sum += expected;
  }
  *bias = difference / sum;
  return deviation / sum;
}

TEST(MultipleScattering, AStretchIsTheSumOfItsCollisions) {
  for (const float g : {0.0f, 0.7f})
    for (const float depth : {0.05f, 0.19f, 0.5f, 0.99f, 1.01f, 2.0f, kInfinity}) {
      double bias = 0;
      // Two tables simulated apart. Noise of a look-up in these small ones, which the difference of two makes larger.
      const double noise = g > 0 ? 0.045 : 0.02;
      const double larger = depth > 1 ? 1 / (1 - std::exp(-static_cast<double>(depth))) : 1;
      EXPECT_LT(stretch_error(g, 0.9f, depth, depth, &bias), noise * (1 + larger)) << "g " << g << ", depth " << depth;
      EXPECT_NEAR(bias, 0, 0.02) << "g " << g << ", depth " << depth;
      stretch_error(g, 0.9f, depth, depth < 1 ? 1.1f * depth : 0.7f * std::min(depth, 3.0f), &bias);
      EXPECT_GT(std::abs(bias), 0.025) << "a stretch of another length is not noticed";
    }
}

TEST(MultipleScattering, ScalesWithTheMedium) {
  const MultipleScattering one(medium(Spectrum(1.0f), 0.9f, 0.7f), small_table(0.7f));
  const MultipleScattering four(medium(Spectrum(4.0f), 0.9f, 0.7f), small_table(0.7f));
  Rng rng(4);
  for (int i = 0; i < 50; ++i) {
    const Vec3 at(0.1f, 0.2f, 0.3f), d = direction(rng), x = at + direction(rng) * 3.0f, w = direction(rng);
    EXPECT_NEAR(four.source_radiance(at, d, at + (x - at) / 4.0f, w)[0], 64 * one.source_radiance(at, d, x, w)[0],
                1e-3f * 64 * one.source_radiance(at, d, x, w)[0] + 1e-9f);
  }
}

TEST(MultipleScattering, EachChannelHasItsOwnMeanFreePath) {
  const Spectrum sigma_t(0.5f, 1, 2), sigma_s(0.25f, 0.9f, 0);
  const HomogeneousMedium colourful(sigma_t, sigma_s, std::make_shared<HenyeyGreensteinPhase>(0.7f));
  const MultipleScattering all(colourful, small_table(0.7f));
  const Vec3 at(0), d(0, 0, 1), x(1, 0.5f, 2), w = normalize(Vec3(1, 1, 1));
  const Spectrum found = all.source_radiance({at, d, 3}, x, w);
  for (int c = 0; c < 2; ++c) {
    const MultipleScattering grey(medium(Spectrum(sigma_t[c]), sigma_s[c] / sigma_t[c], 0.7f), small_table(0.7f));
    EXPECT_FLOAT_EQ(found[c], grey.source_radiance({at, d, 3}, x, w)[0]);
  }
  EXPECT_EQ(found[2], 0);
}

/// The mean over u of a query along the sensor's ray over the plain integral, and the root mean square deviation.
template <class Query, class Source>
std::pair<double, double> view_error(const Stretch& view, float sigma_t, const Query& query, const Source& source) {
  constexpr int kSteps = 20000, kTries = 400;
  const float length = std::min(view.length, 20 / sigma_t);
  double expected = 0, sum = 0, squares = 0;
  for (int i = 0; i < kSteps; ++i) {
    const float t = length * (static_cast<float>(i) + 0.5f) / kSteps;
    expected += static_cast<double>(std::exp(-sigma_t * t) * source(view.origin + view.direction * t)) *
                static_cast<double>(length) / kSteps;
  }
  for (int i = 0; i < kTries; ++i) {
    const double value = static_cast<double>(query((static_cast<float>(i) + 0.5f) / kTries)) / expected;
    sum += value / kTries;
    squares += sqr(value - 1) / kTries;
  }
  return {sum, std::sqrt(squares)};
}

TEST(MultipleScattering, SensorRaysAreIntegrals) {
  const float sigma_t = 2;
  const MultipleScattering light(medium(Spectrum(sigma_t), 0.9f, 0.7f), small_table(0.7f));
  const Vec3 at(0), d(0, 0, 1);
  for (const float off : {0.02f, 0.3f, 2.0f})
    for (const float length : {0.4f, 3.0f, kInfinity}) {
      const Stretch view{{off, -1, 0.2f}, {0, 1, 0}, length};
      const auto [point_mean, point_rms] = view_error(
          view, sigma_t, [&](float u) { return light.radiance(at, d, view, u)[0]; },
          [&](const Vec3& x) { return light.source_radiance(at, d, x, -view.direction)[0]; });
      EXPECT_NEAR(point_mean, 1, 0.01) << off << " " << length;
      EXPECT_LT(point_rms, 0.15) << off << " " << length << ": spread over u";
      const Stretch segment{at - d * 0.3f, d, 1};
      const auto [segment_mean, segment_rms] = view_error(
          view, sigma_t, [&](float u) { return light.radiance(segment, view, u)[0]; },
          [&](const Vec3& x) { return light.source_radiance(segment, x, -view.direction)[0]; });
      EXPECT_NEAR(segment_mean, 1, 0.01) << off << " " << length;
      // Where both rays all but cross, light rises like the logarithm of the distance.
      EXPECT_LT(segment_rms, off < 0.1f ? 0.3 : 0.15) << off << " " << length << ": spread over u";
    }
}

// Any number of points, in eights or not; several lights at once.
TEST(MultipleScattering, SensorRaysOfMorePointsAreTheSame) {
  const float sigma_t = 2;
  const MultipleScattering light(medium(Spectrum(sigma_t), 0.9f, 0.7f), small_table(0.7f));
  const Stretch view{{0.5f, -1, 0.2f}, {0, 1, 0}, 3};
  const Stretch one{{0, 0, 0}, {0, 0, 1}, 1}, two{{0.1f, 0, 0.4f}, {1, 0, 0}, 0.3f};
  const std::array<WeightedStretch, 2> both{{{one, 1}, {two, -0.2f}}};
  for (const int samples : {1, 3, 6}) {
    const auto [mean, rms] = view_error(
        view, sigma_t, [&](float u) { return light.radiance(both, view, u, samples)[0]; },
        [&](const Vec3& x) { return light.source_radiance(both, x, -view.direction)[0]; });
    EXPECT_NEAR(mean, 1, 0.01) << samples;
  }
}

}  // namespace
}  // namespace turbid::testing
