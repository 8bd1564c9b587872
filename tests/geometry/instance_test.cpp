#include "geometry/instance.h"

#include <gtest/gtest.h>

#include "shapes_for_tests.h"

namespace turbid {
namespace {
using namespace turbid::testing;
using Shapes = std::vector<std::shared_ptr<const Shape>>;

std::shared_ptr<const ShapeGroup> group_of(Shapes members) {
  return std::make_shared<const ShapeGroup>(ShapeGroup{std::move(members)});
}

MeshData mapped(MeshData mesh, const Transform& to_world) {
  transform_mesh(mesh, to_world);
  return mesh;
}

const Transform kPlacements[] = {
    Transform(), Transform::translate(3, -2, 1) * Transform::rotate(1, 2, 3, 50) * Transform::scale(2, 2, 2),
    Transform::translate(1, 1, 1) * Transform::scale(-0.5, 0.5, 0.5),
    Transform::rotate(1, 0, 1, 20) * Transform::scale(3, 1, 0.25) * Transform::rotate(0, 1, 1, 70)};

TEST(Instance, ShowsWhatTheMappedMeshShows) {
  const MeshData data = make_bumpy_sphere(1, 0.3f, 3, 7, 3);
  const auto group = group_of({std::make_shared<Disk>(Transform::translate(0, 0, -50)), mesh_shape(data)});
  for (const Transform& to_world : kPlacements) {
    const RayCaster instances(place_group(group, to_world));
    const auto plain = std::make_shared<TriangleMesh>(mapped(data, to_world));
    const RayCaster caster({plain});
    EXPECT_NEAR(instances.shape(1).area(), plain->area(), 1e-5f * plain->area());
    EXPECT_TRUE(instances.shape(1).is_closed());
    Rng rng(1);
    int hits = 0;
    for (int i = 0; i < 3000; ++i) {
      const Vec3 target = to_world.point(random_direction(rng) * rng.next_float());
      const Vec3 direction = random_direction(rng);
      const Ray ray{target - direction * 5.0f, direction};
      const Hit hit = instances.intersect(ray), expected = caster.intersect(ray);
      ASSERT_EQ(bool(hit), bool(expected));
      EXPECT_EQ(instances.occluded(ray), bool(expected));
      if (!hit) continue;
      ++hits;
      EXPECT_EQ(hit.shape, 1u);
      EXPECT_NEAR(hit.t, expected.t, 1e-4f);
      const SurfacePoint s = instances.shape(1).surface_point(ray, hit), e = plain->surface_point(ray, expected);
      if (hit.primitive != expected.primitive) continue;  // through an edge
      EXPECT_LT(length(s.p - e.p), 1e-3f);                // points near edges are moved inwards, by the error of each
      EXPECT_LT(std::abs(dot(s.p - e.p, e.ng)), s.error + e.error);
      EXPECT_GT(dot(s.ng, e.ng), 0.99999f);
      if (to_world.uniform_scale() > 0) {  // else the normals between vertices are others
        EXPECT_GT(dot(s.shading.n, e.shading.n), 0.9999f);
      }
      EXPECT_GT(dot(normalize(hit.ng), e.ng), 0.9999f);
      EXPECT_GE(s.error, e.error * 0.5f);
      EXPECT_LT(s.error, 1e-4f);
    }
    EXPECT_GT(hits, 1000);
  }
}

TEST(Instance, SpheresBecomeEllipsoids) {
  const auto group = group_of({std::make_shared<Sphere>(Vec3(0.5f, 0, 0), 1.0f)});
  const Transform& to_world = kPlacements[3];
  const RayCaster caster(place_group(group, to_world));
  Rng rng(2);
  for (int i = 0; i < 1000; ++i) {
    const Vec3 direction = random_direction(rng);
    const Ray ray{to_world.point({0.5f, 0, 0}) - direction * 9.0f, direction};
    const Hit hit = caster.intersect(ray);
    ASSERT_TRUE(hit);
    const SurfacePoint s = caster.shape(0).surface_point(ray, hit);
    EXPECT_LT(length(s.p - ray.at(hit.t)), 1e-5f);  // the rounding of t, seen along the surface
    const Vec3 n = to_world.inverse().point(s.p) - Vec3(0.5f, 0, 0);
    EXPECT_NEAR(length(n), 1, 1e-5f);
    EXPECT_GT(dot(s.ng, normalize(to_world.normal(n))), 0.99999f);
    EXPECT_LT(std::abs(dot(s.dp_du, s.ng)), 1e-5f * length(s.dp_du));
    EXPECT_LT(std::abs(dot(s.dp_dv, s.ng)), 1e-5f * length(s.dp_dv));
  }
  // Area against the sum of a fine mesh.
  const TriangleMesh mesh(mapped(make_icosphere(1, 6), to_world));
  EXPECT_NEAR(caster.shape(0).area(), mesh.area(), 1e-3f * mesh.area());
}

TEST(Instance, ManyShareAGroupAndNumbersAreThoseOfTheShapes) {
  // A row of pairs between other shapes; the group is built once.
  const auto group = group_of({mesh_shape(make_cube()), std::make_shared<Sphere>(Vec3(0, 0, 3), 1.0f)});
  Shapes shapes{std::make_shared<Disk>(Transform::translate(0, 0, -10))};
  constexpr int kCount = 500;
  for (int i = 0; i < kCount; ++i)
    for (auto& shape : place_group(group, Transform::translate(5.0 * i, 0, 0))) shapes.push_back(shape);
  shapes.push_back(std::make_shared<Disk>(Transform::translate(0, 0, -20)));
  const RayCaster caster(shapes);
  for (int i = 0; i < kCount; ++i) {
    const auto x = static_cast<float>(5 * i);
    EXPECT_EQ(caster.intersect({{x, 0.1f, -5}, {0, 0, 1}}).shape, static_cast<uint32_t>(1 + 2 * i));
    EXPECT_EQ(caster.intersect({{x, 0.1f, 9}, {0, 0, -1}}).shape, static_cast<uint32_t>(2 + 2 * i));
    EXPECT_FALSE(caster.occluded({{x + 2, 0.1f, 9}, {0, 0, -1}, 9}));
  }
  EXPECT_EQ(caster.intersect({{0, 0, -15}, {0, 0, 1}}).shape, 0u);
  EXPECT_EQ(caster.intersect({{0, 0, -15}, {0, 0, -1}}).shape, static_cast<uint32_t>(shapes.size() - 1));
}

TEST(Instance, MembersMustStandSideBySide) {
  const auto group = group_of({mesh_shape(make_cube()), mesh_shape(make_rectangle())});
  Shapes shapes = place_group(group, Transform());
  std::swap(shapes[0], shapes[1]);
  EXPECT_THROW(RayCaster{shapes}, std::invalid_argument);
  EXPECT_THROW(RayCaster({place_group(group, Transform())[0]}), std::invalid_argument);
}

TEST(Instance, FlatPlacementsAreRefused) {
  const auto group = group_of({mesh_shape(make_cube())});
  EXPECT_THROW(place_group(group, Transform::scale(1, 1e-42, 1)), std::invalid_argument);
}

TEST(Instance, ClearanceIsALowerBoundAndCloseForSimilarities) {
  const auto mesh = std::make_shared<TriangleMesh>(make_bumpy_sphere(1, 0.3f, 3, 7, 3));
  const auto group = group_of({mesh, std::make_shared<Cylinder>(Vec3(2, -1, 0), Vec3(2, 1, 0), 0.5f)});
  for (const Transform& to_world : kPlacements) {
    Shapes shapes = place_group(group, to_world);
    for (auto& shape : place_group(group, Transform::translate(-4, 0, 0))) shapes.push_back(shape);
    const RayCaster caster(shapes);
    Rng rng(5);
    for (int i = 0; i < 300; ++i) {
      const Vec3 p = random_in({Vec3(-3.0f), Vec3(3.0f)}, rng);
      const float limit = 2 * rng.next_float(), clearance = caster.clearance(p, limit);
      float bound = limit;
      for (const auto& shape : shapes)
        for (uint32_t k = 0; k < shape->primitive_count(); ++k) bound = std::min(bound, shape->distance_bound(p, k));
      if (to_world.uniform_scale() > 0) {  // else the bounds are not sharp
        EXPECT_LE(clearance, bound);
      }
      EXPECT_GE(clearance, 0.74f * bound);
      // No ray finds a surface nearer than that.
      for (int k = 0; k < 20; ++k) {
        const Hit hit = caster.intersect({p, random_direction(rng)});
        if (hit) {
          EXPECT_GE(hit.t, clearance * (1 - 1e-6f));
        }
      }
      for (const auto& shape : shapes)
        for (int k = 0; k < 20; ++k)
          EXPECT_GE(length(shape->sample_area(random_square(rng)).point.p - p), clearance * (1 - 1e-6f));
    }
  }
}

TEST(Instance, RefusesAWrongBound) {  // the harness above can fail: twice the bound is none
  const auto group = group_of({std::make_shared<Sphere>(Vec3(0), 1.0f)});
  const Shapes shapes = place_group(group, Transform::scale(3, 1, 0.25));
  const RayCaster caster(shapes);
  Rng rng(5);
  int violated = 0;
  for (int i = 0; i < 300; ++i) {
    const Vec3 p = random_in({Vec3(-1.0f), Vec3(1.0f)}, rng);
    for (int k = 0; k < 20; ++k) {
      const Hit hit = caster.intersect({p, Vec3(0, 0, k % 2 == 0 ? 1.0f : -1.0f)});
      violated += hit && hit.t < 2 * caster.clearance(p, kInfinity) ? 1 : 0;
    }
  }
  EXPECT_GT(violated, 0);
}

TEST(Instance, PlacedWithoutSimilarityTheDensityOfSamplesIsTheirs) {
  const auto group = group_of({std::make_shared<Sphere>(Vec3(0), 1.0f)});
  const auto shape = place_group(group, kPlacements[3])[0];
  Rng rng(6);
  double sum = 0;
  constexpr int kSamples = 20000;
  for (int i = 0; i < kSamples; ++i) sum += 1 / double{shape->sample_area(random_square(rng)).pdf_a};
  EXPECT_NEAR(sum / kSamples, shape->area(), 0.02f * shape->area());
}
}  // namespace
}  // namespace turbid
