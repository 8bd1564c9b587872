// Sensors: known pixels look along known rays, and what should be sharp is.
#include "sensor/sensor.h"

#include <gtest/gtest.h>

#include "core/rng.h"
#include "sensor/field_of_view.h"
#include "sensor/orthographic.h"
#include "sensor/perspective.h"
#include "sensor/thin_lens.h"

namespace turbid {
namespace {

/// From (0, 0, 5) towards the origin, y up: +x of the world is on the right of the image.
const Transform kFromZ = Transform::look_at({0, 0, 5}, {0, 0, 0}, {0, 1, 0});
const Vec2 kNoAperture(0.5f, 0.5f);

void expect_near(const Vec3& a, const Vec3& b, float tolerance = 1e-6f) {
  EXPECT_NEAR(length(a - b), 0, tolerance) << a << " and " << b;
}

TEST(FieldOfView, IsConvertedBetweenAxes) {
  const double wide = 1.5;
  EXPECT_EQ(horizontal_fov(40, FovAxis::kX, wide), 40);
  const auto tangent = [](double degrees) { return std::tan(degrees * std::numbers::pi / 360); };
  EXPECT_NEAR(tangent(horizontal_fov(40, FovAxis::kY, wide)), 1.5 * tangent(40), 1e-12);
  EXPECT_NEAR(tangent(horizontal_fov(40, FovAxis::kDiagonal, 0.75)), 0.6 * tangent(40), 1e-12);  // 3-4-5 triangle
  EXPECT_EQ(horizontal_fov(40, FovAxis::kSmaller, wide), horizontal_fov(40, FovAxis::kY, wide));
  EXPECT_EQ(horizontal_fov(40, FovAxis::kSmaller, 0.5), 40);
  EXPECT_EQ(horizontal_fov(40, FovAxis::kLarger, wide), 40);
  EXPECT_EQ(horizontal_fov(40, FovAxis::kLarger, 0.5), horizontal_fov(40, FovAxis::kY, 0.5));
  EXPECT_NEAR(diagonal_fov_of_focal_length(50), 46.7930, 1e-4);
  // On 36 mm x 24 mm film a lens of 18 mm sees 90 degrees across.
  EXPECT_NEAR(horizontal_fov(diagonal_fov_of_focal_length(18), FovAxis::kDiagonal, 1.5), 90, 1e-9);
}

TEST(FieldOfView, RefusesImpossibleValues) {
  EXPECT_THROW(horizontal_fov(0, FovAxis::kX, 1), std::invalid_argument);
  EXPECT_THROW(horizontal_fov(180, FovAxis::kY, 1), std::invalid_argument);
  EXPECT_THROW(horizontal_fov(40, FovAxis::kX, 0), std::invalid_argument);
  EXPECT_THROW(diagonal_fov_of_focal_length(0), std::invalid_argument);
}

TEST(PerspectiveSensor, SeesTheWorldTheRightWayRound) {
  const PerspectiveSensor sensor(kFromZ, 90, 2);
  expect_near(sensor.position(), {0, 0, 5});
  expect_near(sensor.sample_ray({0.5f, 0.5f}, kNoAperture).ray.direction, {0, 0, -1});
  // The edges of the film at 90 degrees across and an aspect of 2, one unit in front.
  const auto at = [&](float x, float y) { return sensor.sample_ray({x, y}, kNoAperture).ray.direction; };
  expect_near(at(1, 0.5f), normalize(Vec3(1, 0, -1)));     // right of the image: +x
  expect_near(at(0, 0.5f), normalize(Vec3(-1, 0, -1)));    // left
  expect_near(at(0.5f, 0), normalize(Vec3(0, 0.5f, -1)));  // top: +y
  expect_near(at(0.5f, 1), normalize(Vec3(0, -0.5f, -1)));
  expect_near(at(0.25f, 0.75f), normalize(Vec3(-0.5f, -0.25f, -1)));
}

TEST(PerspectiveSensor, ClipsAtPlanes) {
  const PerspectiveSensor sensor(kFromZ, 90, 1, {0.5f, 20});
  for (const Vec2& film : {Vec2(0.5f, 0.5f), Vec2(0, 0), Vec2(0.9f, 0.2f)}) {
    const SensorRay sample = sensor.sample_ray(film, kNoAperture);
    expect_near(sample.ray.origin, {0, 0, 5});  // attenuation counts from the pinhole, not from the near plane
    EXPECT_NEAR(sample.ray.at(sample.near_t).z, 4.5f, 1e-5f);
    EXPECT_NEAR(sample.ray.at(sample.ray.t_max).z, -15, 1e-4f);
    EXPECT_EQ(sample.weight, 1);
  }
}

TEST(PerspectiveSensor, MovesItsPrincipalPoint) {
  const PerspectiveSensor plain(kFromZ, 60, 1.5), moved(kFromZ, 60, 1.5, {}, {0.2f, -0.1f});
  // As in Mitsuba: the film point (x, y) sees what (x + 0.2, y - 0.1) saw.
  expect_near(moved.sample_ray({0.3f, 0.6f}, kNoAperture).ray.direction,
              plain.sample_ray({0.5f, 0.5f}, kNoAperture).ray.direction);
}

TEST(PerspectiveSensor, RefusesWhatItCannotBe) {
  EXPECT_THROW(PerspectiveSensor(Transform::scale(2, 2, 2), 40, 1), std::invalid_argument);
  EXPECT_THROW(PerspectiveSensor(Transform::scale(1, 2, 1), 40, 1), std::invalid_argument);
  EXPECT_THROW(PerspectiveSensor(kFromZ, 180, 1), std::invalid_argument);
  EXPECT_THROW(PerspectiveSensor(kFromZ, 40, -1), std::invalid_argument);
  EXPECT_THROW(PerspectiveSensor(kFromZ, 40, 1, {2, 1}), std::invalid_argument);
  EXPECT_THROW(PerspectiveSensor(kFromZ, 40, 1, {-1, 1}), std::invalid_argument);
  EXPECT_NO_THROW(PerspectiveSensor(Transform::scale(-1, 1, 1), 40, 1)) << "mirrored images are fine";
}

/// Largest distance at depth z (from the sensor, along its axis) between rays of one film point through the whole lens.
float blur(const Sensor& sensor, const Vec2& film, float depth) {
  Rng rng(1);
  Vec3 low(kInfinity), high(-kInfinity);
  for (int i = 0; i < 1000; ++i) {
    const float u = rng.next_float();
    const Ray ray = sensor.sample_ray(film, {u, rng.next_float()}).ray;
    const Vec3 p = ray.at((5 - depth - ray.origin.z) / ray.direction.z);
    low = Vec3(std::min(low.x, p.x), std::min(low.y, p.y), 0);
    high = Vec3(std::max(high.x, p.x), std::max(high.y, p.y), 0);
  }
  return std::max(high.x - low.x, high.y - low.y);
}

TEST(ThinLensSensor, IsSharpAtItsFocusAndBlursAsTheLensTells) {
  const ThinLensSensor sensor(kFromZ, 50, 1, 0.2f, 3);
  EXPECT_TRUE(sensor.needs_aperture());
  for (const Vec2& film : {Vec2(0.5f, 0.5f), Vec2(0.1f, 0.8f)}) {
    EXPECT_NEAR(blur(sensor, film, 3), 0, 1e-5f);
    // Circle of confusion at depth z: 2 r |z / f - 1|.
    EXPECT_NEAR(blur(sensor, film, 6), 0.4f, 4e-3f);
    EXPECT_NEAR(blur(sensor, film, 1.5f), 0.2f, 4e-3f);
    EXPECT_NEAR(blur(sensor, film, 0), 0.4f, 4e-3f);  // the lens itself
  }
  // Planted: another focus must not look sharp.
  EXPECT_GT(blur(ThinLensSensor(kFromZ, 50, 1, 0.2f, 3.1f), {0.5f, 0.5f}, 3), 0.01f);
}

TEST(ThinLensSensor, ThroughTheMiddleOfTheLensIsAPinhole) {
  const ThinLensSensor lens(kFromZ, 50, 1.25, 0.3f, 2, {0.5f, 20});
  const PerspectiveSensor pinhole(kFromZ, 50, 1.25, {0.5f, 20});
  for (const Vec2& film : {Vec2(0.5f, 0.5f), Vec2(0, 0), Vec2(0.9f, 0.2f)}) {
    const SensorRay a = lens.sample_ray(film, kNoAperture), b = pinhole.sample_ray(film, kNoAperture);
    expect_near(a.ray.origin, b.ray.origin);
    expect_near(a.ray.direction, b.ray.direction);
    EXPECT_FLOAT_EQ(a.near_t, b.near_t);
    EXPECT_FLOAT_EQ(a.ray.t_max, b.ray.t_max);
  }
  EXPECT_THROW(ThinLensSensor(kFromZ, 50, 1, -0.1f, 3), std::invalid_argument);
  EXPECT_THROW(ThinLensSensor(kFromZ, 50, 1, 0.1f, 0), std::invalid_argument);
}

TEST(ThinLensSensor, ClipsAtPlanes) {
  const ThinLensSensor sensor(kFromZ, 90, 1, 0.5f, 3, {0.5f, 20});
  const SensorRay sample = sensor.sample_ray({0.9f, 0.2f}, {0.1f, 0.7f});
  EXPECT_NEAR(sample.ray.origin.z, 5, 1e-6f);
  EXPECT_NEAR(sample.ray.at(sample.near_t).z, 4.5f, 1e-5f);
  EXPECT_NEAR(sample.ray.at(sample.ray.t_max).z, -15, 1e-4f);
}

TEST(OrthographicSensor, LooksAlongParallelRays) {
  const OrthographicSensor sensor(kFromZ * Transform::scale(3, 3, 1), 2, {0.5f, 20});
  const auto at = [&](float x, float y) { return sensor.sample_ray({x, y}, kNoAperture); };
  // 3 units to each side, half of that up and down.
  expect_near(at(0.5f, 0.5f).ray.origin, {0, 0, 5});
  expect_near(at(1, 0.5f).ray.origin, {3, 0, 5});
  expect_near(at(0, 0).ray.origin, {-3, 1.5f, 5});
  expect_near(at(0.25f, 0.75f).ray.direction, {0, 0, -1});
  expect_near(sensor.position(), {0, 0, 5});
  EXPECT_FLOAT_EQ(at(0, 0).near_t, 0.5f);
  EXPECT_FLOAT_EQ(at(0, 0).ray.t_max, 20);
  EXPECT_THROW(OrthographicSensor(kFromZ, 0), std::invalid_argument);
}

}  // namespace
}  // namespace turbid
