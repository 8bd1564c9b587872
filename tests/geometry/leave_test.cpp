#include <gtest/gtest.h>

#include "geometry/instance.h"
#include "shapes_for_tests.h"

namespace turbid {
namespace {
using namespace turbid::testing;

/// What goes wrong for rays that start on a closed surface.
struct Crossings {
  int rays = 0;
  int wrong_side =
      0;         ///< the next surface met is crossed in the direction of the last: a boundary was missed or met twice
  int lost = 0;  ///< left inwards and met nothing
};

/// A random walk over the inside and the outside of a closed shape: from each hit on in a random direction; every other
/// ray starts afresh and grazes the surface. Along any ray entering and leaving must alternate.
Crossings walk(const std::shared_ptr<const Shape>& owned, int steps, uint64_t seed,
               const std::function<Vec3(const SurfacePoint&, const Vec3&)>& leave) {
  const Shape& shape = *owned;
  const RayCaster caster({owned});
  Crossings result;
  Rng rng(seed);
  SurfacePoint at = shape.sample_area(random_square(rng)).point;
  for (int i = 0; i < steps; ++i) {
    Vec3 direction = random_direction(rng);
    if (i % 2 == 0) {  // within a thousandth of the surface
      at = shape.sample_area(random_square(rng)).point;
      const Vec3 tangent = direction - at.ng * dot(direction, at.ng);
      direction = normalize(tangent + at.ng * (1e-3f * length(tangent) * (2 * rng.next_float() - 1)));
    }
    const bool outwards = leads_outside(at.ng, direction);
    const Ray ray{leave(at, direction), direction};
    const Hit hit = caster.intersect(ray);
    ++result.rays;
    if (hit) {
      const SurfacePoint next = shape.surface_point(ray, hit);
      if (leads_outside(next.ng, direction) == outwards) ++result.wrong_side;
      at = next;
    } else {
      if (!outwards) ++result.lost;
      at = shape.sample_area(random_square(rng)).point;
    }
  }
  return result;
}

/// The same for a shape that the caster does not own.
Crossings walk(const Shape& shape, int steps, uint64_t seed,
               const std::function<Vec3(const SurfacePoint&, const Vec3&)>& leave) {
  return walk(std::shared_ptr<const Shape>(&shape, [](const Shape*) {}), steps, seed, leave);
}

Vec3 leave_rightly(const SurfacePoint& s, const Vec3& d) { return s.leave(d); }

struct Placement {
  double scale;
  Imath::V3d offset;  ///< in units of the scale
};
const Placement kPlacements[] = {{1, {0, 0, 0}},     {1e-3, {0, 0, 0}},         {1e4, {0, 0, 0}},
                                 {1, {30, -20, 10}}, {1e-3, {1000, 300, -500}}, {1e4, {300, 0, 500}}};

TEST(Leave, SpheresAreNeverCrossedTwice) {
  for (const auto& [scale, offset] : kPlacements)
    for (const bool flip : {false, true}) {
      const Sphere sphere(Vec3(offset * scale), float(scale), {}, flip);
      const Crossings c = walk(sphere, 50'000, 1, leave_rightly);
      EXPECT_EQ(c.wrong_side, 0) << scale;
      if (!flip) {
        EXPECT_EQ(c.lost, 0) << scale;
      }
    }
}

TEST(Leave, ConvexMeshesAreNeverCrossedTwice) {
  for (const auto& [scale, offset] : kPlacements)
    for (const MeshData& data : {make_icosphere(1, 3), make_cube(), make_rounded_box({1, 0.5f, 0.25f}, 0.1f, 3)}) {
      const TriangleMesh mesh(placed(data, scale, offset * scale));
      const Crossings c = walk(mesh, 60'000, 2, leave_rightly);
      EXPECT_EQ(c.wrong_side, 0) << data.name << ' ' << scale;
      EXPECT_EQ(c.lost, 0) << data.name << ' ' << scale;
    }
}

TEST(Leave, FoldedMeshesAreNeverCrossedTwice) {
  for (const auto& [scale, offset] : kPlacements)
    for (const MeshData& data : {make_bumpy_sphere(1, 0.4f, 4, 3, 4), make_torus(1, 0.4f, 40, 20)}) {
      const TriangleMesh mesh(placed(data, scale, offset * scale));
      const Crossings c = walk(mesh, 60'000, 3, leave_rightly);
      EXPECT_EQ(c.wrong_side, 0) << data.name << ' ' << scale;
      EXPECT_EQ(c.lost, 0) << data.name << ' ' << scale;
    }
}

TEST(Leave, SliversAreNeverCrossedTwice) {
  // A strip a thousandth thin and a sphere of needles around its poles.
  for (MeshData data : {make_cube(Transform::scale(1, 1e-3, 0.01)), make_uv_sphere(1, 1000, 4)}) {
    transform_mesh(data, Transform::rotate(1, 1, 0, 40));
    const Crossings c = walk(TriangleMesh(data), 200'000, 4, leave_rightly);
    EXPECT_EQ(c.wrong_side, 0) << data.name;
    EXPECT_EQ(c.lost, 0) << data.name;
  }
}

TEST(Leave, InstancesAreNeverCrossedTwice) {
  const std::vector<std::shared_ptr<const Shape>> members{
      mesh_shape(make_icosphere(1, 3)), mesh_shape(placed(make_bumpy_sphere(1, 0.4f, 4, 3, 4), 1, {20, 10, -30})),
      mesh_shape(placed(make_rounded_box({1, 0.5f, 0.25f}, 0.1f, 3), 0.5, {0.1, 0, 0.2})),
      std::make_shared<Sphere>(Vec3(3, 0, 1), 0.5f)};
  for (const auto& member : members) {
    const auto group = std::make_shared<const ShapeGroup>(ShapeGroup{{member}});
    for (const auto& [scale, offset] : kPlacements)
      for (const Transform& stretch : {Transform(), Transform::scale(-3, 1, 0.2)}) {
        const Imath::V3d at = offset * scale;
        const auto shape =
            place_group(group, Transform::translate(at.x, at.y, at.z) * Transform::scale(scale, scale, scale) *
                                   Transform::rotate(1, 2, 3, 70) * stretch)[0];
        const Crossings c = walk(shape, 20'000, 5, leave_rightly);
        EXPECT_EQ(c.wrong_side, 0) << &member - members.data() << ' ' << scale;
        EXPECT_EQ(c.lost, 0) << &member - members.data() << ' ' << scale;
      }
  }
}

TEST(Leave, StartingAtTheHitItselfFails) {  // the harness above can fail
  const TriangleMesh mesh(make_icosphere(1, 3));
  const auto from_point = [](const SurfacePoint& s, const Vec3&) { return s.p; };
  EXPECT_GT(walk(mesh, 60'000, 2, from_point).wrong_side, 100);
  const Sphere sphere({30, -20, 10}, 1);
  const Crossings c = walk(sphere, 60'000, 2, from_point);
  EXPECT_GT(c.wrong_side + c.lost, 100);
}

TEST(Leave, OpenShapesAreLeftToTheChosenSide) {
  for (const auto& [scale, offset] : kPlacements) {
    const Transform place = Transform::translate(offset.x * scale, offset.y * scale, offset.z * scale) *
                            Transform::scale(scale, scale, scale) * Transform::rotate(1, 2, 3, 70);
    const auto disk = std::make_shared<Disk>(place);
    const auto rectangle = std::make_shared<TriangleMesh>(make_rectangle(place));
    const auto tube = std::make_shared<Cylinder>(Vec3(0, 0, -5), Vec3(0, 0, 5), 1.0f, place);
    for (const std::shared_ptr<const Shape>& shape : std::vector<std::shared_ptr<const Shape>>{disk, rectangle, tube}) {
      const RayCaster caster({shape});
      const bool flat = shape != tube;
      Rng rng(9);
      int wrong = 0;
      for (int i = 0; i < 50'000; ++i) {
        const SurfacePoint s = shape->sample_area(random_square(rng)).point;
        Vec3 d = random_direction(rng);
        if (i % 2 == 0) d = normalize(d - s.ng * (dot(d, s.ng) * 0.999f));
        const Hit hit = caster.intersect({s.leave(d), d});
        // Nothing is met from a flat shape or on the outside of a tube; inside, only the tube's inside.
        if (flat || leads_outside(s.ng, d))
          wrong += hit ? 1 : 0;
        else if (hit)
          wrong += dot(d, shape->surface_point({s.leave(d), d}, hit).ng) > 0 ? 0 : 1;
      }
      EXPECT_EQ(wrong, 0) << scale;
    }
  }
}
}  // namespace
}  // namespace turbid
