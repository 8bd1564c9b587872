// Shining shapes: samples, densities and total light against closed forms.
#include "emitter/area_light.h"

#include <gtest/gtest.h>

#include "geometry/disk.h"
#include "geometry/ray_caster.h"
#include "geometry/sphere.h"
#include "testing/chi_square.h"
#include "texture/constant.h"

namespace turbid {
namespace {

constexpr float kRadiance = 5;

AreaLight shining(std::shared_ptr<const Shape> shape) {
  return {std::move(shape), std::make_shared<ConstantTexture>(Spectrum(kRadiance, 2 * kRadiance, 0))};
}

/// Irradiance at `from` on a surface with that normal: the mean of weight times cosine over a lattice of u.
double irradiance(const Emitter& light, const Vec3& from, const Vec3& normal) {
  constexpr int kSide = 256;
  double sum = 0;
  for (int i = 0; i < kSide * kSide; ++i) {
    const Vec2 u((static_cast<float>(i % kSide) + 0.5f) / kSide, (static_cast<float>(i / kSide) + 0.5f) / kSide);
    const auto sample = light.sample_direct(from, u);
    if (sample) sum += static_cast<double>(sample->weight[0] * std::max(0.0f, dot(sample->wi, normal)));
  }
  return sum / (kSide * kSide);
}

/// Directions from sample_direct against the density that a ray cast in that direction finds through pdf_direct_w.
testing::ChiSquareResult test_directions(const AreaLight& sampled, const AreaLight& claimed,
                                         std::shared_ptr<const Shape> shape, const Vec3& from) {
  const RayCaster rays({shape});
  return testing::chi_square_sphere(
      [&](Rng& rng) -> std::optional<Vec3> {
        const float x = rng.next_float();
        const auto sample = sampled.sample_direct(from, Vec2(x, rng.next_float()));
        return sample ? std::optional(sample->wi) : std::nullopt;
      },
      [&](const Vec3& w) {
        const Ray ray{from, w, kInfinity};
        const Hit hit = rays.intersect(ray);
        if (!hit) return 0.0;
        const SurfacePoint point = shape->surface_point(ray, hit);
        return dot(point.ng, w) < 0 ? static_cast<double>(claimed.pdf_direct_w(from, point.p, point.ng)) : 0.0;
      });
}

TEST(AreaLight, SphereGivesItsClosedFormIrradiance) {
  const AreaLight light = shining(std::make_shared<Sphere>(Vec3(1, 2, 3), 0.5f));
  for (const float distance : {0.6f, 1.0f, 5.0f, 100.0f}) {
    // A sphere wholly above the horizon of a surface that faces it: E = pi L (r / d)^2.
    const double expected =
        std::numbers::pi * static_cast<double>(kRadiance) * sqr(0.5 / static_cast<double>(distance));
    const Vec3 normal = normalize(Vec3(1, -1, 0.5f));
    EXPECT_NEAR(irradiance(light, Vec3(1, 2, 3) - normal * distance, normal) / expected, 1, 1e-4) << distance;
  }
}

TEST(AreaLight, DiskGivesItsClosedFormIrradiance) {
  const AreaLight light = shining(std::make_shared<Disk>());
  // On its axis at height h, facing it: E = pi L r^2 / (r^2 + h^2).
  for (const float h : {0.2f, 1.0f, 10.0f}) {
    const double expected = std::numbers::pi * static_cast<double>(kRadiance) / (1 + sqr(static_cast<double>(h)));
    EXPECT_NEAR(irradiance(light, Vec3(0, 0, h), Vec3(0, 0, -1)) / expected, 1, 2e-4) << h;
  }
}

TEST(AreaLight, ShinesOnItsOutsideOnly) {
  const auto disk = std::make_shared<Disk>();
  const AreaLight light = shining(disk);
  EXPECT_EQ(irradiance(light, Vec3(0, 0, -1), Vec3(0, 0, 1)), 0);
  const SurfacePoint point = disk->sample_area(Vec2(0.5f, 0.25f)).point;
  EXPECT_EQ(light.Le(point, Vec3(0, 0, 1)), Spectrum(kRadiance, 2 * kRadiance, 0));
  EXPECT_EQ(light.Le(point, Vec3(0, 0, -1)), Spectrum());
}

TEST(AreaLight, IsSampledAsItSays) {
  const Vec3 from(0.3f, -0.2f, 1.1f);
  const std::shared_ptr<const Shape> shapes[] = {
      std::make_shared<Sphere>(Vec3(1, 2, 3), 0.5f), std::make_shared<Sphere>(Vec3(0), 1.0f), std::make_shared<Disk>(),
      std::make_shared<Disk>(Transform::translate(0, 0, 2) * Transform::rotate(1, 0, 0, 140))};
  for (const auto& shape : shapes) {
    const auto result = test_directions(shining(shape), shining(shape), shape, from);
    EXPECT_TRUE(passes(result, static_cast<int>(std::size(shapes)))) << result.report;
  }
}

TEST(AreaLight, PlantedErrorIsFound) {
  // The density claimed is that of a sphere 3 % larger.
  const auto sphere = std::make_shared<Sphere>(Vec3(0, 0, 2), 1.0f),
             larger = std::make_shared<Sphere>(Vec3(0, 0, 2), 1.03f);
  const Vec3 from(0, 0, 0.5f);
  EXPECT_FALSE(passes(test_directions(shining(sphere), shining(larger), sphere, from), 100));
}

TEST(AreaLight, WeightIsRadianceOverDensity) {
  const auto sphere = std::make_shared<Sphere>(Vec3(1, 2, 3), 0.5f);
  const AreaLight light = shining(sphere);
  const Vec3 from(0.3f, -0.2f, 1.1f);
  Rng rng(5);
  for (int i = 0; i < 100; ++i) {
    const auto sample = light.sample_direct(from, Vec2(rng.next_float(), 0.5f));
    ASSERT_TRUE(sample);
    EXPECT_FALSE(sample->delta);
    EXPECT_NEAR(sample->weight[0] * sample->pdf_w, kRadiance, 1e-4f);
    EXPECT_NEAR(length(from + sample->wi * sample->distance - sample->position), 0, 1e-5f);
  }
}

TEST(AreaLight, SendsPiTimesAreaTimesRadiance) {
  const AreaLight light = shining(std::make_shared<Sphere>(Vec3(1, 2, 3), 0.5f));
  EXPECT_FLOAT_EQ(light.power()[0], kPi * kRadiance * kPi);
  EXPECT_FLOAT_EQ(light.power()[1], 2 * kPi * kRadiance * kPi);
}

}  // namespace
}  // namespace turbid
