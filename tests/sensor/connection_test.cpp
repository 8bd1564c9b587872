// Ways from points to the sensor: their importance is the density of the film that sample_ray shows them on.
#include <gtest/gtest.h>

#include "core/rng.h"
#include "core/warp.h"
#include "sensor/orthographic.h"
#include "sensor/perspective.h"
#include "sensor/thin_lens.h"

namespace turbid {
namespace {

const Transform kView = Transform::look_at({1, 2, 5}, {0.2f, 0, 0}, {0, 1, 0});

Vec2 next_2d(Rng& rng) {
  const float u = rng.next_float();
  return {u, rng.next_float()};
}

struct Estimate {
  double mean = 0, error = 0;
};

template <class Sample>
Estimate estimate(int n, const Sample& sample) {
  double sum = 0, squares = 0;
  for (int i = 0; i < n; ++i) {
    const double value = sample();
    sum += value;
    squares += value * value;
  }
  const double mean = sum / n;
  return {mean, std::sqrt(std::max(0.0, squares / n - mean * mean) / n)};
}

/// A parallelogram in the world.
struct Patch {
  Vec3 corner, a, b;
  Vec3 at(const Vec2& u) const { return corner + a * u.x + b * u.y; }
  bool is_hit(const SensorRay& sensor) const {
    const Vec3 n = cross(a, b);
    const float t = dot(corner - sensor.ray.origin, n) / dot(sensor.ray.direction, n);
    if (!(t > sensor.near_t && t < sensor.ray.t_max)) return false;
    const Vec3 p = sensor.ray.at(t) - corner;
    const float u = dot(cross(p, b), n) / length_squared(n), v = dot(cross(a, p), n) / length_squared(n);
    return u > 0 && u < 1 && v > 0 && v < 1;
  }
};

/// The share of the film on which the patch is seen times the mean of a pattern on the film: by rays from the sensor
/// and by connections from points of the patch.
void expect_same_share(const Sensor& sensor, const Patch& patch, double bias = 1) {
  const auto pattern = [](const Vec2& film) { return double{1 + film.x + 2 * film.y * film.y}; };
  Rng rng(5);
  const Estimate by_rays = estimate(400000, [&] {
    const Vec2 film = next_2d(rng);
    return patch.is_hit(sensor.sample_ray(film, next_2d(rng))) ? bias * pattern(film) : 0;
  });
  const Estimate by_points = estimate(400000, [&] {
    const Vec3 p = patch.at(next_2d(rng));
    const auto way = sensor.connect(p, next_2d(rng));
    if (!way || way->film.x < 0 || way->film.x >= 1 || way->film.y < 0 || way->film.y >= 1) return 0.0;
    const float projected = std::abs(dot(cross(patch.a, patch.b), normalize(way->position - p)));
    return static_cast<double>(way->importance * projected) * pattern(way->film);
  });
  EXPECT_GT(by_rays.mean, 0.01);
  const double z = (by_rays.mean - by_points.mean) / std::hypot(by_rays.error, by_points.error);
  if (bias == 1)
    EXPECT_LT(std::abs(z), 3.5) << by_rays.mean << " against " << by_points.mean;
  else
    EXPECT_GT(std::abs(z), 3.5);
}

const Patch kPatch{{-1, -1, 0}, {1.5f, 0.3f, 0.5f}, {0.2f, 1.2f, -0.8f}};
const Patch kHuge{{-40, -40, -3}, {80, 0, 9}, {0, 80, 0}};  // beyond the film on all sides

TEST(SensorConnection, OfAPinhole) {
  const PerspectiveSensor sensor(kView, 50, 1.5, {}, {0.1f, -0.05f});
  expect_same_share(sensor, kPatch);
  expect_same_share(sensor, kHuge);
}

TEST(SensorConnection, HarnessNoticesAPlantedError) {
  expect_same_share(PerspectiveSensor(kView, 50, 1.5), kPatch, 1.05);
}

TEST(SensorConnection, OfAThinLens) {
  const ThinLensSensor sensor(kView, 50, 0.75, 0.4f, 3);
  expect_same_share(sensor, kPatch);
  expect_same_share(sensor, kHuge);
}

TEST(SensorConnection, OfAnOrthographicSensor) {
  const Transform sheared = kView * Transform::scale(2, 1.5f, 0.5f);
  expect_same_share(OrthographicSensor(sheared, 1.5), kPatch);
}

TEST(SensorConnection, KeepsToTheClippingPlanes) {
  const ClipRange clip{4.5f, 5.5f};  // through the patch
  expect_same_share(PerspectiveSensor(kView, 50, 1.5, clip), kPatch);
  expect_same_share(ThinLensSensor(kView, 50, 1.5, 0.3f, 3, clip), kPatch);
  expect_same_share(OrthographicSensor(kView * Transform::scale(2, 2, 1), 1.5, clip), kPatch);
}

TEST(SensorConnection, LeadsBackAlongTheRay) {
  const PerspectiveSensor pinhole(kView, 50, 1.5, {}, {0.1f, 0});
  const ThinLensSensor lens(kView, 50, 1.5, 0.3f, 3);
  const OrthographicSensor parallel(kView, 1.5);
  Rng rng(2);
  for (const Sensor* sensor : {static_cast<const Sensor*>(&pinhole), static_cast<const Sensor*>(&lens),
                               static_cast<const Sensor*>(&parallel)}) {
    for (int i = 0; i < 100; ++i) {
      const Vec2 film = next_2d(rng), aperture = next_2d(rng);
      const SensorRay ray = sensor->sample_ray(film, aperture);
      const auto way = sensor->connect(ray.ray.at(2 + 5 * rng.next_float()), aperture);
      ASSERT_TRUE(way);
      EXPECT_NEAR((way->film - film).length(), 0, 1e-4f);
      EXPECT_NEAR(length(way->position - ray.ray.origin), 0, 1e-5f);
      EXPECT_NEAR(way->near_t, ray.near_t, 1e-5f);
      EXPECT_FALSE(sensor->connect(ray.ray.at(-1), aperture)) << "behind the sensor";
    }
  }
}

// The whole sky lands on the film once.
TEST(SensorConnection, ToInfinityIsADensityOverDirections) {
  const PerspectiveSensor pinhole(kView, 70, 1.5);
  const ThinLensSensor lens(kView, 70, 1.5, 0.3f, 3);
  Rng rng(4);
  for (const Sensor* sensor : {static_cast<const Sensor*>(&pinhole), static_cast<const Sensor*>(&lens)}) {
    const Estimate film = estimate(400000, [&] {
      const auto way = sensor->connect_to_infinity(square_to_sphere(next_2d(rng)), next_2d(rng));
      if (!way || way->film.x < 0 || way->film.x >= 1 || way->film.y < 0 || way->film.y >= 1) return 0.0;
      return static_cast<double>(way->importance / kUniformSpherePdfW);
    });
    EXPECT_LT(std::abs(film.mean - 1) / film.error, 3.5) << film.mean;
  }
  EXPECT_FALSE(OrthographicSensor(kView, 1).connect_to_infinity({0, 0, -1}, {0, 0}));
}

}  // namespace
}  // namespace turbid
