#include "geometry/sdf_grid.h"

#include <gtest/gtest.h>

#include "shapes_for_tests.h"

namespace turbid {
namespace {
using namespace turbid::testing;
using Imath::V3d;

template <class Function>
SdfSamples sampled(std::array<int, 3> size, const Function& f) {
  SdfSamples s{size, {}};
  for (int z = 0; z < size[2]; ++z)
    for (int y = 0; y < size[1]; ++y)
      for (int x = 0; x < size[0]; ++x)
        s.values.push_back(static_cast<float>(
            f(V3d(double(x) / (size[0] - 1), double(y) / (size[1] - 1), double(z) / (size[2] - 1)))));
  return s;
}

double ball(const V3d& p) { return (p - V3d(0.5)).length() - 0.3; }
double lumps(const V3d& p) {
  return (p - V3d(0.5)).length() - 0.28 + 0.08 * std::sin(20 * p.x) * std::sin(23 * p.y) * std::sin(19 * p.z);
}

TEST(SdfGrid, ABallIsABall) {
  const auto grid = std::make_shared<SdfGrid>(sampled({40, 50, 60}, ball), SdfGrid::Normals::kSmooth,
                                              Transform::translate(1, 2, 3) * Transform::scale(2, 2, 2));
  EXPECT_TRUE(grid->is_closed());
  const RayCaster caster({grid});
  Rng rng(1);
  for (int i = 0; i < 2000; ++i) {
    const Vec3 direction = random_direction(rng);
    const Ray ray{Vec3(2, 3, 4) - direction * 5.0f + random_direction(rng) * 0.3f, direction};
    const Hit hit = caster.intersect(ray);
    ASSERT_TRUE(hit);
    EXPECT_TRUE(caster.occluded(ray));
    const SurfacePoint s = grid->surface_point(ray, hit);
    const Vec3 out = s.p - Vec3(2, 3, 4);
    EXPECT_LT(length(s.p - ray.at(hit.t)), 1e-5f);
    EXPECT_NEAR(length(out), 0.6f, 1e-3f);  // the interpolant's curvature: step^2 / (8 radius)
    EXPECT_GT(dot(s.ng, normalize(out)), 0.998f);
    EXPECT_GT(dot(s.shading.n, normalize(out)), 0.9995f);
    EXPECT_GT(dot(hit.ng, normalize(out)), 0.998f);
  }
}

TEST(SdfGrid, APlaneIsExact) {
  // Trilinear interpolation leaves a linear function as it is, whatever the map and the resolution.
  const V3d normal(0.3, -0.5, 0.8);
  const Transform to_world =
      Transform::rotate(1, 2, 3, 30) * Transform::scale(3, 1, 0.5) * Transform::translate(-0.5, -0.5, -0.5);
  for (const auto normals : {SdfGrid::Normals::kAnalytic, SdfGrid::Normals::kSmooth}) {
    const SdfGrid grid(sampled({4, 7, 3}, [&](const V3d& p) { return (p - V3d(0.5)).dot(normal); }), normals, to_world);
    EXPECT_FALSE(grid.is_closed());
    const RayCaster caster({std::shared_ptr<const Shape>(&grid, [](const Shape*) {})});
    const Vec3 expected = normalize(to_world.normal(Vec3(normal)));
    Rng rng(2);
    for (int i = 0; i < 500; ++i) {
      const Vec3 direction = random_direction(rng);
      const Ray ray{direction * -3.0f, direction};  // through the origin, which is the middle of the plane
      const Hit hit = caster.intersect(ray);
      ASSERT_TRUE(hit);
      EXPECT_NEAR(hit.t, 3, 1e-5f / std::abs(dot(direction, expected)));
      const SurfacePoint s = grid.surface_point(ray, hit);
      EXPECT_GT(dot(s.ng, expected), 0.99999f);
      EXPECT_GT(dot(s.shading.n, expected), 0.9999f);
    }
  }
}

/// How often a random walk through a shape fails to leave what it entered.
int wrong_crossings(const std::shared_ptr<const Shape>& shape, const Vec3& inside, bool leave_rightly) {
  const RayCaster caster({shape});
  Rng rng(3);
  int wrong = 0;
  Ray ray{inside, random_direction(rng)};
  bool outwards = true;  // which way the next crossing must lead
  for (int i = 0; i < 40'000; ++i) {
    const Hit hit = caster.intersect(ray);
    if (!hit) {
      wrong += outwards ? 1 : 0;
      ray = {inside, random_direction(rng)};
      outwards = true;
      continue;
    }
    const SurfacePoint s = shape->surface_point(ray, hit);
    wrong += leads_outside(s.ng, ray.direction) != outwards ? 1 : 0;
    const Vec3 d = random_direction(rng);
    ray = {leave_rightly ? s.leave(d) : s.p, d};
    outwards = !leads_outside(s.ng, d);
  }
  return wrong;
}

TEST(SdfGrid, IsNeverCrossedTwiceAndHasNoHoles) {
  for (const Transform& to_world :
       {Transform(), Transform::scale(1e3, 1e3, 1e3), Transform::rotate(1, 2, 3, 40) * Transform::scale(-3, 1, 0.5),
        Transform::translate(50, -20, 30)}) {
    const auto grid = std::make_shared<SdfGrid>(sampled({24, 20, 28}, lumps), SdfGrid::Normals::kAnalytic, to_world);
    EXPECT_TRUE(grid->is_closed());
    EXPECT_EQ(wrong_crossings(grid, to_world.point(Vec3(0.5f)), true), 0);
  }
}

TEST(SdfGrid, StartingAtTheHitItselfFails) {  // the harness above can fail
  EXPECT_GT(wrong_crossings(std::make_shared<SdfGrid>(sampled({24, 20, 28}, lumps), SdfGrid::Normals::kAnalytic,
                                                      Transform::translate(50, -20, 30)),
                            Vec3(50.5f, -19.5f, 30.5f), false),
            100);
}

TEST(SdfGrid, ClearanceIsFree) {
  const auto grid = std::make_shared<SdfGrid>(sampled({24, 20, 28}, lumps), SdfGrid::Normals::kSmooth,
                                              Transform::rotate(1, 2, 3, 40) * Transform::scale(3, 1, 0.5));
  const RayCaster caster({grid});
  Rng rng(4);
  for (int i = 0; i < 2000; ++i) {
    const Vec3 p = random_in(grid->bounds(), rng);
    const float free = caster.clearance(p, kInfinity);
    const Hit hit = caster.intersect({p, random_direction(rng)});
    if (hit) {
      EXPECT_GE(hit.t, free * (1 - 1e-6f));
    }
  }
}

TEST(SdfGrid, RefusesWhatHasNoSurface) {
  const auto refuses = [](SdfSamples samples) {
    EXPECT_THROW(SdfGrid(std::move(samples), SdfGrid::Normals::kSmooth), std::invalid_argument);
  };
  refuses({{2, 2, 1}, {1, 1, 1, -1}});
  refuses({{2, 2, 2}, {1, 1, 1, -1}});
  refuses({{2, 2, 2}, {1, 1, 1, 1, 1, 1, 1, 1}});
  refuses({{2, 2, 2}, {1, 1, 1, -1, 1, 1, 1, kInfinity}});
}
}  // namespace
}  // namespace turbid
