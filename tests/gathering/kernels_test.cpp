// The kernels of gathering volumes against integrals taken point by point, and the index against asking all.
#include <gtest/gtest.h>

#include "core/warp.h"
#include "gathering/gather_kernels.h"
#include "gathering/gather_settings.h"
#include "gathering/volume_index.h"
#include "medium/isotropic.h"
#include "path/passage.h"

namespace turbid::testing {
namespace {

Vec3 point_in_cube(Rng& rng, float half) {
  const auto coordinate = [&] { return half * (2 * rng.next_float() - 1); };
  const float x = coordinate(), y = coordinate();
  return {x, y, coordinate()};
}
Vec3 direction(Rng& rng) {
  const float u = rng.next_float();
  return square_to_sphere({u, rng.next_float()});
}

HomogeneousMedium medium(bool grey) {
  const Spectrum sigma_t = grey ? Spectrum(0.7f) : Spectrum(0.2f, 0.7f, 1.9f);
  return {sigma_t, sigma_t * 0.5f, std::make_shared<IsotropicPhase>()};
}

GatherVolume random_cylinder(Rng& rng) {
  GatherVolume cylinder{.origin = point_in_cube(rng, 1), .direction = direction(rng)};
  cylinder.radius = 0.3f + 0.5f * rng.next_float();
  cylinder.length = 0.5f + rng.next_float();
  cylinder.start = rng.next_float();
  cylinder.weight = {0.5f, 1, 2};
  return cylinder;
}

bool is_inside(const GatherVolume& cylinder, const Vec3& p) {
  const Vec3 from = p - cylinder.origin;
  const float along = dot(from, cylinder.direction);
  return along >= 0 && along < cylinder.length &&
         length_squared(from - cylinder.direction * along) < sqr(cylinder.radius);
}

/// The integral of flux times weight along the ray, by the midpoint rule over what lies inside.
Spectrum by_points(const LightSegment& segment, const GatherVolume& cylinder, bool long_cylinder,
                   const HomogeneousMedium& medium) {
  constexpr int kPoints = 20000;
  const float step = segment.ray.t_max / kPoints;
  Spectrum sum;
  for (int i = 0; i < kPoints; ++i) {
    const float t = (static_cast<float>(i) + 0.5f) * step;
    const Vec3 p = segment.ray.at(t);
    if (!is_inside(cylinder, p)) continue;
    const float along = cylinder.start + dot(p - cylinder.origin, cylinder.direction);
    const Spectrum passed = medium.transmittance(along);
    const Spectrum front = long_cylinder ? passed : passed / (channel_mix(cylinder.weight) * passed).sum();
    const Spectrum arrived = medium.transmittance(t);
    sum += segment.flux * front * (segment.is_long ? arrived : arrived / (segment.mix * arrived).sum()) * step;
  }
  return sum;
}

/// Largest difference of flux_through from the integral, in units of the largest value; `slip` is added to the cosine
/// that the kernel sees, by turning the cylinder's flight.
double worst_difference(bool grey, bool long_cylinder, bool long_segment, float slip = 0) {
  Rng rng(5);
  const HomogeneousMedium fog = medium(grey);
  double worst = 0, scale = 0;
  for (int i = 0; i < 60; ++i) {
    const GatherVolume cylinder = random_cylinder(rng);
    LightSegment segment{{point_in_cube(rng, 2), direction(rng), 4}, {1, 2, 3}, long_segment, {0.2f, 0.3f, 0.5f}};
    const Spectrum expected = by_points(segment, cylinder, long_cylinder, fog);
    GatherVolume seen = cylinder;
    seen.start += slip;
    Spectrum found;
    const Chord chord = chord_in(segment.ray, cylinder);
    constexpr int kDraws = 256;
    if (!chord.empty())
      for (int k = 0; k < kDraws; ++k)
        found +=
            flux_through(segment, seen, chord, long_cylinder, fog, (static_cast<float>(k) + 0.5f) / kDraws) / kDraws;
    for (int c = 0; c < kChannels; ++c) {
      worst = std::max(worst, std::abs(static_cast<double>(found[c] - expected[c])));
      scale = std::max(scale, static_cast<double>(expected[c]));
    }
  }
  return worst / scale;
}

TEST(GatherKernels, CylindersIntegrateAlongTheChord) {
  // The integral by points errs by a step at each end.
  constexpr double kStep = 1e-3;
  for (const bool grey : {true, false})
    for (const bool long_cylinder : {true, false})
      for (const bool long_segment : {true, false})
        EXPECT_LT(worst_difference(grey, long_cylinder, long_segment), kStep)
            << grey << " " << long_cylinder << " " << long_segment;
  EXPECT_GT(worst_difference(true, true, false, 0.05f), 10 * kStep) << "a wrong place on the flight is noticed";
}

TEST(GatherKernels, ParallelAndPerpendicularChords) {
  GatherVolume cylinder{.origin = Vec3(0), .direction = Vec3(0, 0, 1)};
  cylinder.radius = 1;
  cylinder.length = 2;
  const Chord across = chord_in({Vec3(-5, 0, 1), Vec3(1, 0, 0), 100}, cylinder);
  EXPECT_NEAR(across.from, 4, 1e-6);
  EXPECT_NEAR(across.to, 6, 1e-6);
  const Chord along = chord_in({Vec3(0.5f, 0, -1), Vec3(0, 0, 1), 100}, cylinder);
  EXPECT_NEAR(along.from, 1, 1e-6);
  EXPECT_NEAR(along.to, 3, 1e-6);
  EXPECT_TRUE(chord_in({Vec3(1.5f, 0, -1), Vec3(0, 0, 1), 100}, cylinder).empty());
  EXPECT_TRUE(chord_in({Vec3(-5, 0, 3), Vec3(1, 0, 0), 100}, cylinder).empty());
  EXPECT_NEAR(chord_in({Vec3(-5, 0, 1), Vec3(1, 0, 0), 5}, cylinder).to, 5, 1e-6) << "the segment ends inside";
}

TEST(GatherKernels, SpheresAreCrossedAtTheirDisk) {
  const Ray ray{Vec3(0), Vec3(1, 0, 0), 10};
  EXPECT_NEAR(nearest_within(ray, Vec3(4, 0.5f, 0), 0.6f), 4, 1e-6f);
  EXPECT_LT(nearest_within(ray, Vec3(4, 0.5f, 0), 0.4f), 0);
  EXPECT_LT(nearest_within(ray, Vec3(10.1f, 0, 0), 1), 0) << "touches the sphere, but ends before its disk";
  EXPECT_LT(nearest_within(ray, Vec3(-0.1f, 0, 0), 1), 0);
}

TEST(VolumeIndex, FindsWhatAskingAllFinds) {
  Rng rng(3);
  std::vector<GatherVolume> volumes;
  for (int i = 0; i < 3000; ++i) {
    volumes.push_back({.origin = point_in_cube(rng, 2), .direction = direction(rng)});
    volumes.back().radius = 0.01f + 0.2f * rng.next_float();
    volumes.back().length = i % 2 ? 1.0f : 0.0f;
  }
  VolumeIndex index;
  EXPECT_TRUE(index.empty());
  index.around(Vec3(0), [](uint32_t) { FAIL() << "nothing is there"; });
  index.build(volumes.size(), [&](size_t i) { return volumes[i].bounds(); });
  const auto crossed = [&](const Ray& ray, uint32_t i) {
    return volumes[i].is_sphere() ? nearest_within(ray, volumes[i].origin, volumes[i].radius) > 0
                                  : !chord_in(ray, volumes[i]).empty();
  };
  size_t found = 0, tested = 0;
  for (int k = 0; k < 200; ++k) {
    const Ray ray{point_in_cube(rng, 3), direction(rng), 6 * rng.next_float()};
    std::vector<int> times(volumes.size());
    index.along(ray, [&](uint32_t i) { ++times[i]; });
    for (uint32_t i = 0; i < volumes.size(); ++i) {
      EXPECT_LE(times[i], 1);
      tested += static_cast<size_t>(times[i]);
      if (!crossed(ray, i)) continue;
      EXPECT_EQ(times[i], 1);
      ++found;
    }
    std::fill(times.begin(), times.end(), 0);
    index.around(ray.origin, [&](uint32_t i) { ++times[i]; });
    for (uint32_t i = 0; i < volumes.size(); ++i)
      EXPECT_EQ(times[i] > 0, volumes[i].bounds().intersects(ray.origin)) << "a point lies in a box or does not";
  }
  EXPECT_GT(found, 500u);
  EXPECT_LT(tested, volumes.size() * 200 / 5) << "most boxes are not even touched";
}

TEST(RadiusFactor, FollowsTheRecursion) {
  // Knaus & Zwicker 2011, eq. 15: measure n+1 over measure n is (n + keep) / (n + 1).
  for (const int dimensions : {2, 3}) {
    EXPECT_FLOAT_EQ(radius_factor(0, 0.6f, dimensions), 1);
    for (uint64_t i = 1; i < 1000; i += 37) {
      const double step = std::pow(static_cast<double>(radius_factor(i, 0.6f, dimensions)) /
                                       static_cast<double>(radius_factor(i - 1, 0.6f, dimensions)),
                                   dimensions);
      EXPECT_NEAR(step, (static_cast<double>(i) + 0.6f) / (static_cast<double>(i) + 1), 1e-5) << i;
    }
    EXPECT_FLOAT_EQ(radius_factor(12345, 1, dimensions), 1);
  }
}

}  // namespace
}  // namespace turbid::testing
