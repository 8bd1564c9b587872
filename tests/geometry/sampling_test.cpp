#include <gtest/gtest.h>

#include "shapes_for_tests.h"
#include "testing/chi_square.h"

namespace turbid {
namespace {
using namespace turbid::testing;

TEST(Sphere, DirectSamplesFillTheConeUniformly) {
  const Sphere sphere({0, 0, 5}, 1);
  const Sphere far({0, 0, 1000}, 1);  // half angle 1e-3: cancellation would show
  const Sphere near({0, 0, 1.001f}, 1);
  for (const Sphere* s : {&sphere, &far, &near}) {
    const double sine = 1.0 / double(s->center().z), solid = 1 - std::sqrt((1 - sine) * (1 + sine));
    std::optional<float> pdf;
    // The cone, stretched to a square: height by solid angle, azimuth.
    const auto result = chi_square_square(
        [&](Rng& rng) -> std::optional<Vec2> {
          const auto d = s->sample_direct({0, 0, 0}, random_square(rng));
          const Imath::V3d w = Imath::V3d(d->point.p).normalized();
          pdf = d->pdf_w;
          const double one_minus_cos = (w.x * w.x + w.y * w.y) / (1 + w.z);
          const double phi = std::atan2(w.y, w.x) / (2 * std::numbers::pi);
          return Vec2(float(one_minus_cos / solid), float(phi < 0 ? phi + 1 : phi));
        },
        [](const Vec2&) { return 1.0; });
    EXPECT_TRUE(passes(result, 3)) << result.report;
    EXPECT_NEAR(double(*pdf) * 2 * std::numbers::pi * solid, 1, 1e-4);
  }
}

/// Directions from `from` against pdf_direct_w, which must be the density of those that see the shape.
ChiSquareResult direct_sampling(const Shape& shape, const Vec3& from, bool plant_error = false) {
  const RayCaster caster({std::shared_ptr<const Shape>(&shape, [](const Shape*) {})});
  ChiSquareSettings settings;
  settings.theta_bins = 8;
  settings.phi_bins = 16;
  return chi_square_sphere(
      [&](Rng& rng) -> std::optional<Vec3> {
        const auto d = shape.sample_direct(from, random_square(rng));
        if (!d) return std::nullopt;
        EXPECT_NEAR(d->pdf_w, shape.pdf_direct_w(from, d->point.p, d->point.ng), 1e-3f * d->pdf_w);
        return normalize(d->point.p - from);
      },
      [&](const Vec3& w) {
        double pdf = 0;  // every layer of the shape along w contributes where sampling is by area
        Ray ray{from, w};
        for (int layer = 0; layer < 8; ++layer) {
          const Hit hit = caster.intersect(ray);
          if (!hit) break;
          const SurfacePoint s = shape.surface_point(ray, hit);
          const double p = double(shape.pdf_direct_w(from, s.p, s.ng));
          if (dynamic_cast<const Sphere*>(&shape) == nullptr || layer == 0) pdf += p;
          ray.origin = s.leave(w);
        }
        return plant_error ? 0.9 * pdf : pdf;
      },
      settings);
}

TEST(Shapes, DirectSamplesFollowTheirDensity) {
  const TriangleMesh box(make_cube(Transform::rotate(1, 1, 0, 30)));
  const Disk disk(Transform::rotate(1, 0, 1, 20) * Transform::scale(2, 3, 1));
  const Cylinder tube({0, -1, 0}, {0, 1, 0}, 0.8f);
  const Sphere sphere({0, 0, 0}, 1);
  EXPECT_TRUE(passes(direct_sampling(box, {0.3f, 0.1f, -0.2f}), 5));
  EXPECT_TRUE(passes(direct_sampling(disk, {0.3f, 0.1f, 2.2f}), 5));
  EXPECT_TRUE(passes(direct_sampling(tube, {0.1f, 0.2f, 0.3f}), 5));
  EXPECT_TRUE(passes(direct_sampling(sphere, {0.1f, 0.2f, 0.3f}), 5));
  EXPECT_TRUE(passes(direct_sampling(sphere, {0, 0, 1.5f}), 5));
  EXPECT_FALSE(passes(direct_sampling(sphere, {0, 0, 1.5f}, true), 5));
}

TEST(Shapes, AreaSamplesAreUniform) {
  const TriangleMesh lopsided([] {  // one big and one small triangle of a unit square
    MeshData m;
    m.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.3f, 0.5f, 0}};
    m.indices = {0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4};
    return m;
  }());
  const auto on_mesh = chi_square_square(
      [&](Rng& rng) -> std::optional<Vec2> {
        const AreaSample s = lopsided.sample_area(random_square(rng));
        EXPECT_FLOAT_EQ(s.pdf_a, 1.0f);
        return Vec2(s.point.p.x, s.point.p.y);
      },
      [](const Vec2&) { return 1.0; });
  EXPECT_TRUE(passes(on_mesh, 4)) << on_mesh.report;

  const Sphere sphere({1, 2, 3}, 2);
  const auto on_sphere = chi_square_sphere(
      [&](Rng& rng) -> std::optional<Vec3> {
        return normalize(sphere.sample_area(random_square(rng)).point.p - sphere.center());
      },
      [](const Vec3&) { return 0.25 / std::numbers::pi; });
  EXPECT_TRUE(passes(on_sphere, 4)) << on_sphere.report;

  const Cylinder tube({0, 0, 0}, {0, 0, 3}, 0.5f);
  const auto on_tube =
      chi_square_square([&](Rng& rng) -> std::optional<Vec2> { return tube.sample_area(random_square(rng)).point.uv; },
                        [](const Vec2&) { return 1.0; });
  EXPECT_TRUE(passes(on_tube, 4)) << on_tube.report;

  const Disk disk(Transform::scale(2, 5, 1));
  const auto on_disk = chi_square_square(
      [&](Rng& rng) -> std::optional<Vec2> {
        const Vec2 uv = disk.sample_area(random_square(rng)).point.uv;
        return Vec2(uv.x * uv.x, uv.y);
      },
      [](const Vec2&) { return 1.0; });
  EXPECT_TRUE(passes(on_disk, 4)) << on_disk.report;
}
}  // namespace
}  // namespace turbid
