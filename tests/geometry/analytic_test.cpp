#include <gtest/gtest.h>

#include "geometry/azimuth.h"
#include "shapes_for_tests.h"

namespace turbid {
namespace {
using namespace turbid::testing;

SurfacePoint hit_point(const Shape& shape, const Vec3& origin, const Vec3& direction) {
  const RayCaster caster({std::shared_ptr<const Shape>(&shape, [](const Shape*) {})});
  const Ray ray{origin, normalize(direction)};
  const Hit hit = caster.intersect(ray);
  EXPECT_TRUE(hit);
  return shape.surface_point(ray, hit);
}

/// dp_du and dp_dv against differences of p for close points.
void check_derivatives(const Shape& shape, const Vec3& origin, const Vec3& direction) {
  const SurfacePoint a = hit_point(shape, origin, direction);
  for (const Vec3& shift : {Vec3(2e-3f, 1e-3f, 0), Vec3(-1e-3f, 2e-3f, 1e-3f)}) {
    const SurfacePoint b = hit_point(shape, origin, normalize(direction) + shift);
    const Vec2 duv = b.uv - a.uv;
    const Vec3 predicted = a.dp_du * duv.x + a.dp_dv * duv.y;
    EXPECT_LT(length(predicted - (b.p - a.p)), 0.01f * length(b.p - a.p));
  }
  EXPECT_NEAR(dot(a.shading.n, a.shading.s), 0, 1e-6f);
  EXPECT_GT(dot(a.shading.s, a.dp_du), 0);
}

TEST(Sphere, FollowsMitsuba) {
  const Sphere sphere({1, 2, 3}, 2);
  const SurfacePoint s = hit_point(sphere, {1, 2, 10}, {0, 0, -1});
  EXPECT_EQ(s.p, Vec3(1, 2, 5));
  EXPECT_EQ(s.ng, Vec3(0, 0, 1));
  EXPECT_NEAR(s.uv.y, 0, 1e-6f);  // the pole
  const SurfacePoint side = hit_point(sphere, {1, 20, 3}, {0, -1, 0});
  EXPECT_NEAR(side.uv.x, 0.25f, 1e-6f);
  EXPECT_NEAR(side.uv.y, 0.5f, 1e-6f);
  check_derivatives(sphere, {5, 6, 4}, {-1, -1, -0.2f});
  EXPECT_FLOAT_EQ(sphere.area(), 16 * kPi);
  const Sphere turned({0, 0, 0}, 1, Transform::rotate(1, 0, 0, 90) * Transform::scale(3, 3, 3), true);
  EXPECT_FLOAT_EQ(turned.radius(), 3);
  EXPECT_EQ(hit_point(turned, {0, 0, 10}, {0, 0, -1}).ng, Vec3(0, 0, -1));
  EXPECT_NEAR(hit_point(turned, {0, -10, 0}, {0, 1, 0}).uv.y, 0, 1e-6f);  // z axis mapped to -y
  EXPECT_THROW(Sphere({0, 0, 0}, 1, Transform::scale(1, 2, 1)), std::invalid_argument);
  EXPECT_THROW(Sphere({0, 0, 0}, -1), std::invalid_argument);
  EXPECT_THROW(Sphere({0, 0, kInfinity}, 1), std::invalid_argument);
}

TEST(Disk, FollowsMitsuba) {
  const Disk disk(Transform::translate(0, 0, 1) * Transform::scale(2, 3, 1));
  const SurfacePoint s = hit_point(disk, {0, 1.5f, 5}, {0, 0, -1});
  EXPECT_EQ(s.ng, Vec3(0, 0, 1));
  EXPECT_NEAR(s.uv.x, 0.5f, 1e-6f);
  EXPECT_NEAR(s.uv.y, 0.25f, 1e-6f);
  EXPECT_FLOAT_EQ(disk.area(), 6 * kPi);
  check_derivatives(disk, {0.3f, 0.8f, 3}, {0.1f, 0.2f, -1});
  EXPECT_EQ(hit_point(Disk({}, true), {0.1f, 0, 5}, {0, 0, -1}).ng, Vec3(0, 0, -1));
  EXPECT_FALSE(RayCaster({std::make_shared<Disk>()}).intersect({{0.8f, 0.8f, 1}, {0, 0, -1}}));
  EXPECT_THROW(Disk(Transform::rotate(0, 0, 1, 45) * Transform::scale(1, 2, 1) * Transform::rotate(0, 0, 1, 30)),
               std::invalid_argument);
}

TEST(Cylinder, FollowsMitsuba) {
  const Cylinder tube({0, 0, 0}, {0, 0, 4}, 2);
  const SurfacePoint s = hit_point(tube, {0, 10, 1}, {0, -1, 0});
  EXPECT_LT(length(s.p - Vec3(0, 2, 1)), 1e-6f);
  EXPECT_LT(length(s.ng - Vec3(0, 1, 0)), 1e-6f);
  EXPECT_NEAR(s.uv.x, 0.25f, 1e-6f);
  EXPECT_NEAR(s.uv.y, 0.25f, 1e-6f);
  EXPECT_FLOAT_EQ(tube.area(), 16 * kPi);
  check_derivatives(tube, {5, 6, 4}, {-1, -1, -0.2f});
  // Through the open end onto the inside.
  EXPECT_GT(dot(hit_point(tube, {0, 0, 6}, {0, 1, -1.5f}).ng, Vec3(0, 1, 0)), 0.99f);
  EXPECT_FALSE(RayCaster({std::make_shared<Cylinder>(Vec3(0, 0, 0), Vec3(0, 0, 4), 2.0f)})
                   .intersect({{0.1f, 0, 9}, {0, 0, -1}}));
  EXPECT_THROW(Cylinder({0, 0, 0}, {0, 0, 0}, 1), std::invalid_argument);
  EXPECT_THROW(Cylinder({0, 0, 0}, {0, 0, 1}, 0), std::invalid_argument);
  EXPECT_THROW(Cylinder({0, 0, 0}, {0, 0, 1}, 1, Transform::scale(2, 1, 1)), std::invalid_argument);
  EXPECT_FLOAT_EQ(Cylinder({0, 0, 0}, {0, 0, 1}, 1, Transform::scale(2, 2, 5)).area(), 20 * kPi);  // stretching is fine
}

TEST(AnalyticShapes, TurnsAreAzimuths) {
  for (int i = 0; i <= 3600; ++i) {
    const double phi = 2 * std::numbers::pi * i / 3600;
    const auto x = static_cast<float>(3 * std::cos(phi)), y = static_cast<float>(3 * std::sin(phi));
    double expected = std::atan2(double{y}, double{x}) / (2 * std::numbers::pi);
    if (expected < 0) expected += 1;
    EXPECT_NEAR(turn_of(x, y), expected, 1e-7) << i;
  }
  EXPECT_EQ(turn_of(0, 0), 0);
  EXPECT_EQ(turn_of(-2, 0), 0.5f);
}

TEST(AnalyticShapes, BoundsEnclose) {
  const Transform turn = Transform::translate(1, 2, 3) * Transform::rotate(1, 2, 3, 50);
  const std::vector<std::shared_ptr<const Shape>> shapes{
      std::make_shared<Sphere>(Vec3(1, 0, 0), 2.0f, turn), std::make_shared<Disk>(turn * Transform::scale(2, 1, 1)),
      std::make_shared<Cylinder>(Vec3(0, 0, 0), Vec3(1, 1, 1), 0.3f, turn)};
  Rng rng(1);
  for (const auto& shape : shapes) {
    Bounds3 around;
    for (int i = 0; i < 20'000; ++i) around.extendBy(shape->sample_area(random_square(rng)).point.p);
    const Bounds3 b = shape->bounds();
    for (int k = 0; k < 3; ++k) {
      EXPECT_LE(b.min[k], around.min[k] + 1e-6f);
      EXPECT_GE(b.max[k], around.max[k] - 1e-6f);
      EXPECT_NEAR(b.min[k], around.min[k], 0.03f);  // and tight
      EXPECT_NEAR(b.max[k], around.max[k], 0.03f);
    }
  }
}
}  // namespace
}  // namespace turbid
