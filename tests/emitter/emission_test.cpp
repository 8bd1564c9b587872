// Rays that leave lights: together they carry the light's power, and they light a target as sample_direct does.
#include <gtest/gtest.h>

#include "core/rng.h"
#include "core/warp.h"
#include "emitter/area_light.h"
#include "emitter/collimated_beam.h"
#include "emitter/constant_environment.h"
#include "emitter/directional_light.h"
#include "emitter/environment_map.h"
#include "emitter/point_light.h"
#include "emitter/projector.h"
#include "emitter/spot_light.h"
#include "geometry/sphere.h"
#include "texture/constant.h"

namespace turbid {
namespace {

Vec2 next_2d(Rng& rng) {
  const float u = rng.next_float();
  return {u, rng.next_float()};
}

struct Estimate {
  double mean = 0, error = 0;
};

/// Mean and standard error of n values.
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

/// Power that crosses a small sphere: by rays from the light that hit it, and by next-event estimation towards points
/// all around its surface. The same light, found from both of its ends.
void expect_same_light(const Emitter& light, const Vec3& target, double bias = 1) {
  constexpr float kRadius = 0.5f;
  const Sphere sphere(target, kRadius);
  Rng rng(11);
  const Estimate forward = estimate(400000, [&] {
    const Vec2 u_position = next_2d(rng);
    const auto ray = light.sample_emission(u_position, next_2d(rng));
    if (!ray || !std::isfinite(sphere.intersect(ray->origin, ray->direction))) return 0.0;
    return bias * static_cast<double>(ray->weight.mean());
  });
  const Estimate backward = estimate(400000, [&] {
    const AreaSample at = sphere.sample_area(next_2d(rng));
    const auto towards = light.sample_direct(at.point.p, next_2d(rng));
    if (!towards) return 0.0;
    const float cosine = std::max(0.0f, dot(at.point.ng, towards->wi));
    return static_cast<double>(towards->weight.mean() * cosine / at.pdf_a);
  });
  EXPECT_GT(backward.mean, 0);
  EXPECT_LT(backward.error + forward.error, 0.03 * backward.mean) << "too noisy to say anything";
  const double z = (forward.mean - backward.mean) / std::hypot(forward.error, backward.error);
  if (bias == 1)
    EXPECT_LT(std::abs(z), 3.5) << forward.mean << " against " << backward.mean;
  else
    EXPECT_GT(std::abs(z), 3.5);
}

const Vec3 kTarget{0.3f, -0.2f, 0.4f};

TEST(Emission, PointLight) { expect_same_light(PointLight({1.5f, 0, 0}, Spectrum(2, 3, 4)), kTarget); }

TEST(Emission, HarnessNoticesAPlantedError) {
  expect_same_light(PointLight({1.5f, 0, 0}, Spectrum(2, 3, 4)), kTarget, 1.05);
}

TEST(Emission, SpotLight) {
  const Transform to_world = Transform::look_at({2, 1, 0}, {0, 0, 0}, {0, 0, 1});
  expect_same_light(SpotLight(to_world, Spectrum(5), 30, 12), kTarget);
}

TEST(Emission, SpotLightWiderThanAHemisphere) {
  const Transform to_world = Transform::look_at({1.5f, 0, 0}, {3, 0, 0}, {0, 0, 1});
  expect_same_light(SpotLight(to_world, Spectrum(5), 170, 20), kTarget);
}

TEST(Emission, Projector) {
  const Transform to_world = Transform::look_at({0, 0, 3}, {0, 0, 0}, {0, 1, 0});
  expect_same_light(Projector(to_world, std::make_shared<ConstantTexture>(2.0f), 1.5f, 40, 1.5), kTarget);
}

TEST(Emission, AreaLight) {
  const auto ball = std::make_shared<Sphere>(Vec3(2, 0, 0), 0.7f);
  expect_same_light(AreaLight(ball, std::make_shared<ConstantTexture>(3.0f)), kTarget);
}

TEST(Emission, LightsAtInfinity) {
  std::vector<Spectrum> pixels(16 * 8, Spectrum(0.1f));
  pixels[40] = Spectrum(30, 20, 10);
  ConstantEnvironment constant(Spectrum(2));
  EnvironmentMap map(pixels, 16, 8, {}, 1.5f);
  DirectionalLight sun({1, 2, -0.5f}, Spectrum(4));
  for (Emitter* light : {static_cast<Emitter*>(&constant), static_cast<Emitter*>(&map), static_cast<Emitter*>(&sun)}) {
    light->set_scene_bounds({0.1f, 0, 0.1f}, 1.5f);
    expect_same_light(*light, kTarget);
  }
}

TEST(Emission, RaysFromInfinityStartOnTheBoundingSphereAndCarryThePower) {
  ConstantEnvironment sky(Spectrum(2));
  sky.set_scene_bounds({1, 2, 3}, 2);
  Rng rng(3);
  for (int i = 0; i < 1000; ++i) {
    const Vec2 u_position = next_2d(rng);
    const auto ray = sky.sample_emission(u_position, next_2d(rng));
    ASSERT_TRUE(ray);
    EXPECT_NEAR(length(ray->origin - Vec3(1, 2, 3)), 2, 1e-5);
    EXPECT_LE(dot(ray->direction, ray->origin - Vec3(1, 2, 3)), 1e-5);
    EXPECT_NEAR(ray->weight[0], sky.power()[0], 1e-3f * sky.power()[0]);
  }
}

/// emission_pdf against the samples: the same numbers for the same ray, and a density of directions that integrates to
/// one where there is one.
void expect_pdf_of_samples(const Emitter& light) {
  Rng rng(5);
  Vec3 ng(0);
  bool has_density = false;
  for (int i = 0; i < 1000; ++i) {
    const Vec2 u_position = next_2d(rng);
    const auto ray = light.sample_emission(u_position, next_2d(rng));
    ASSERT_TRUE(ray);
    const EmissionPdf pdf = light.emission_pdf(ray->ng, ray->direction);
    EXPECT_NEAR(pdf.pdf_a, ray->pdf.pdf_a, 1e-5f * ray->pdf.pdf_a);
    EXPECT_NEAR(pdf.pdf_w, ray->pdf.pdf_w, 1e-3f * ray->pdf.pdf_w);
    ng = ray->ng;
    has_density = ray->pdf.pdf_w > 0;
  }
  if (!has_density) return;
  const Estimate integral = estimate(400000, [&] {
    const Vec2 u = next_2d(rng);
    return static_cast<double>(light.emission_pdf(ng, square_to_sphere(u)).pdf_w / kUniformSpherePdfW);
  });
  EXPECT_LT(std::abs(integral.mean - 1), 3.5 * integral.error + 1e-6);
}

TEST(Emission, DensitiesAreThoseOfTheSamples) {
  const Transform to_world = Transform::look_at({2, 1, 0}, {0, 0, 0}, {0, 0, 1});
  const auto ball = std::make_shared<Sphere>(Vec3(2, 0, 0), 0.7f);
  expect_pdf_of_samples(PointLight({1.5f, 0, 0}, Spectrum(2, 3, 4)));
  expect_pdf_of_samples(SpotLight(to_world, Spectrum(5), 30, 12));
  expect_pdf_of_samples(SpotLight(to_world, Spectrum(5), 170, 12));
  expect_pdf_of_samples(Projector(to_world, std::make_shared<ConstantTexture>(2.0f), 1.5f, 40, 1.5));
  expect_pdf_of_samples(AreaLight(ball, std::make_shared<ConstantTexture>(3.0f)));
  expect_pdf_of_samples(CollimatedBeam(to_world, Spectrum(1), 0.2f));
  std::vector<Spectrum> pixels(16 * 8, Spectrum(0.1f));
  pixels[40] = Spectrum(30, 20, 10);
  EnvironmentMap map(pixels, 16, 8, {}, 1.5f);
  DirectionalLight sun({1, 2, -0.5f}, Spectrum(4));
  for (Emitter* light : {static_cast<Emitter*>(&map), static_cast<Emitter*>(&sun)}) {
    light->set_scene_bounds({0.1f, 0, 0.1f}, 1.5f);
    expect_pdf_of_samples(*light);
  }
}

TEST(CollimatedBeam, SendsParallelRaysFromItsDisk) {
  const Transform to_world = Transform::look_at({0, 0, 3}, {1, 0, 0}, {0, 1, 0});
  const CollimatedBeam beam(to_world, Spectrum(3, 2, 1), 0.25f);
  const Vec3 axis = normalize(Vec3(1, 0, -3));
  Rng rng(9);
  Vec3 mean(0);
  double mean_square = 0;
  constexpr int kRays = 20000;
  for (int i = 0; i < kRays; ++i) {
    const Vec2 u_position = next_2d(rng);
    const auto ray = beam.sample_emission(u_position, next_2d(rng));
    ASSERT_TRUE(ray);
    EXPECT_LT(length(ray->direction - axis), 1e-6f);
    EXPECT_EQ(ray->weight, Spectrum(3, 2, 1));
    const Vec3 offset = ray->origin - Vec3(0, 0, 3);
    EXPECT_NEAR(dot(offset, axis), 0, 1e-6f);
    EXPECT_LE(length(offset), 0.25f + 1e-6f);
    EXPECT_TRUE(beam.bounds().intersects(ray->origin));
    mean += offset / kRays;
    mean_square += static_cast<double>(length_squared(offset)) / kRays;
  }
  EXPECT_LT(length(mean), 0.25f * 4 / std::sqrt(float{kRays}));
  EXPECT_NEAR(mean_square, 0.25 * 0.25 / 2, 0.25 * 0.25 * 4 / std::sqrt(kRays));  // uniform over the disk
  EXPECT_FALSE(beam.sample_direct({1, 0, 0}, {0.5f, 0.5f}));
  EXPECT_FALSE(beam.can_be_aimed_at());
  EXPECT_EQ(CollimatedBeam(to_world, Spectrum(1), 0).emission_pdf({}, axis).pdf_a, 0);
  EXPECT_THROW(CollimatedBeam(to_world, Spectrum(1), -1), std::invalid_argument);
}

}  // namespace
}  // namespace turbid
