#include "photon/point_tree.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/rng.h"
#include "photon/beam_crossing.h"

namespace turbid {
namespace {

Vec3 random_point(Rng& rng) { return {rng.next_float(), rng.next_float(), rng.next_float()}; }

/// Many in a clump, some along a line, some twice in one place, the rest anywhere.
std::vector<Vec3> random_points(Rng& rng, size_t count) {
  std::vector<Vec3> points;
  for (size_t i = 0; i < count; ++i) {
    const Vec3 p = random_point(rng);
    if (i % 4 == 0)
      points.push_back(p);
    else if (i % 4 == 1)
      points.push_back(Vec3(0.4f) + p * 0.01f);
    else if (i % 4 == 2)
      points.push_back({p.x, 0.25f, 0.75f});
    else
      points.push_back(points[points.size() / 2]);
  }
  return points;
}

/// What the callers of PointTree test themselves.
bool is_near(const Ray& ray, const Vec3& p, float radius) {
  const float t = std::clamp(dot(p - ray.origin, ray.direction), 0.0f, ray.t_max);
  return length_squared(p - ray.at(t)) < sqr(radius);
}

TEST(PointTree, FindsEveryPointNearARayOrAPlaceOnce) {
  Rng rng(1);
  for (const size_t count : {0u, 1u, 8u, 9u, 17u, 1000u, 40000u}) {
    const std::vector<Vec3> points = random_points(rng, count);
    PointTree tree;
    tree.build(points);
    EXPECT_EQ(tree.empty(), count == 0);
    for (int query = 0; query < 200; ++query) {
      const float radius = std::exp(-7 * rng.next_float());
      Ray ray{random_point(rng), normalize(random_point(rng) - random_point(rng)), 2 * rng.next_float()};
      if (query % 5 == 0) ray.direction = Vec3(0, query % 2 ? 1.0f : -1.0f, 0);
      std::vector<uint32_t> along, around, along_expected, around_expected;
      tree.along(ray, radius, [&](uint32_t i) {
        if (is_near(ray, points[i], radius)) along.push_back(i);
      });
      const Ray place{ray.origin, ray.direction, 0};
      tree.around(ray.origin, radius, [&](uint32_t i) {
        if (is_near(place, points[i], radius)) around.push_back(i);
      });
      for (uint32_t i = 0; i < count; ++i) {
        if (is_near(ray, points[i], radius)) along_expected.push_back(i);
        if (is_near(place, points[i], radius)) around_expected.push_back(i);
      }
      std::sort(along.begin(), along.end());
      std::sort(around.begin(), around.end());
      ASSERT_EQ(along, along_expected) << count << " points, radius " << radius;
      ASSERT_EQ(around, around_expected) << count << " points, radius " << radius;
    }
  }
}

// Two beams through random points of a common perpendicular of known length.
TEST(BeamCrossing, IsOnTheCommonPerpendicular) {
  Rng rng(2);
  for (int n = 0; n < 2000; ++n) {
    const Vec3 a = normalize(random_point(rng) - Vec3(0.5f)), b = normalize(random_point(rng) - Vec3(0.5f));
    const Vec3 normal = cross(a, b);
    const float sine = length(normal);
    if (sine < 0.05f) continue;
    const Vec3 p = random_point(rng);
    const float gap = 0.1f * rng.next_float(), on_a = rng.next_float() * 2, on_b = rng.next_float() * 2;
    const Ray first{p - a * on_a, a, 1}, second{p + normal * (gap / sine) - b * on_b, b, 1};
    const auto crossing = find_crossing(first, second, 0.05f);
    const bool expected = gap < 0.05f && on_a < 1 && on_b < 1;
    const float margin = std::min({std::abs(gap - 0.05f), std::abs(on_a - 1), std::abs(on_b - 1), on_a, on_b});
    if (margin < 1e-4f) continue;
    ASSERT_EQ(crossing.has_value(), expected) << gap << " " << on_a << " " << on_b;
    if (!crossing) continue;
    EXPECT_NEAR(crossing->on_first, on_a, 1e-4f);
    EXPECT_NEAR(crossing->on_second, on_b, 1e-4f);
    EXPECT_NEAR(crossing->sine, sine, 1e-5f);
  }
  EXPECT_FALSE(find_crossing({Vec3(0), Vec3(0, 0, 1), 1}, {Vec3(0.01f, 0, 0), Vec3(0, 0, 1), 1}, 0.1f)) << "parallel";
}

}  // namespace
}  // namespace turbid
