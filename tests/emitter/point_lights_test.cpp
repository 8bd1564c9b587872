// Lights without area: what arrives, and how much they send in all.
#include <gtest/gtest.h>

#include "emitter/directional_light.h"
#include "emitter/point_light.h"
#include "emitter/spot_light.h"
#include "testing/chi_square.h"

namespace turbid {
namespace {

const Transform kSlanted = Transform::look_at({1, 2, 3}, {2, 4, 2}, {0, 0, 1});

TEST(PointLight, FallsWithTheSquareOfTheDistance) {
  const PointLight light(Vec3(1, 0, 0), Spectrum(8, 4, 2));
  const auto sample = light.sample_direct(Vec3(1, 0, -2), Vec2(0.5f));
  ASSERT_TRUE(sample);
  EXPECT_EQ(sample->wi, Vec3(0, 0, 1));
  EXPECT_EQ(sample->distance, 2);
  EXPECT_EQ(sample->position, Vec3(1, 0, 0));
  EXPECT_EQ(sample->weight, Spectrum(2, 1, 0.5f));
  EXPECT_TRUE(sample->delta);
  EXPECT_EQ(sample->pdf_w, 0);
  EXPECT_FALSE(light.sample_direct(Vec3(1, 0, 0), Vec2(0.5f))) << "at the light itself";
  EXPECT_FALSE(light.can_be_hit());
  EXPECT_FALSE(light.is_at_infinity());
}

TEST(PointLight, SendsItsPowerThroughAnySphere) {
  const PointLight light(Vec3(0.1f, 0.2f, 0.3f), Spectrum(8, 4, 2));
  // The flux through the unit sphere about the origin, which the light is inside of but not at the centre.
  const double flux = testing::integrate_sphere([&](const Vec3& p) {
    const auto sample = light.sample_direct(p, Vec2(0));
    return static_cast<double>(sample->weight[0] * std::max(0.0f, -dot(p, sample->wi)));
  });
  EXPECT_NEAR(flux, static_cast<double>(light.power()[0]), 1e-3);
}

TEST(DirectionalLight, ShinesAlongItsDirectionWithItsIrradiance) {
  DirectionalLight light(Vec3(0, -2, 0), Spectrum(3, 2, 1));
  light.set_scene_bounds(Vec3(5, 5, 5), 10);
  const auto sample = light.sample_direct(Vec3(7, 8, 9), Vec2(0.5f));
  ASSERT_TRUE(sample);
  EXPECT_EQ(sample->wi, Vec3(0, 1, 0));
  EXPECT_EQ(sample->distance, kInfinity);
  EXPECT_EQ(sample->weight, Spectrum(3, 2, 1));
  EXPECT_TRUE(sample->delta);
  EXPECT_FLOAT_EQ(light.power()[0], 3 * kPi * 100);
  EXPECT_TRUE(light.is_at_infinity());
  EXPECT_FALSE(light.is_environment());
  EXPECT_THROW(DirectionalLight(Vec3(0), Spectrum(1.0f)), std::invalid_argument);
}

/// Radiance colours by uv, to see where the projection of a spot light looks it up.
class UvTexture final : public Texture {
 public:
  Spectrum eval(const SurfacePoint& point) const override { return {point.uv.x, point.uv.y, 1}; }
  Spectrum mean() const override { return {0.5f, 0.5f, 1}; }
  float max() const override { return 1; }
};

/// Intensity in the light's own space at the angle (degrees) from the axis.
float spot_at(const SpotLight& light, const Transform& to_world, float degrees) {
  const float angle = degrees * kPi / 180;
  return light.intensity(to_world.vector(Vec3(std::sin(angle) * 0.6f, std::sin(angle) * 0.8f, std::cos(angle))))[0];
}

TEST(SpotLight, FallsLinearlyBetweenBeamAndCutoff) {
  const SpotLight light(kSlanted, Spectrum(10.0f), 40, 20);
  EXPECT_FLOAT_EQ(spot_at(light, kSlanted, 0), 10);
  EXPECT_FLOAT_EQ(spot_at(light, kSlanted, 19.9f), 10);
  EXPECT_NEAR(spot_at(light, kSlanted, 25), 7.5f, 1e-4f);
  EXPECT_NEAR(spot_at(light, kSlanted, 35), 2.5f, 1e-4f);
  EXPECT_EQ(spot_at(light, kSlanted, 40.1f), 0);
  EXPECT_EQ(spot_at(light, kSlanted, 180), 0);
}

TEST(SpotLight, SamplesItsIntensityOverTheSquaredDistance) {
  const SpotLight light(kSlanted, Spectrum(10, 5, 1), 40, 20);
  const Vec3 position(1, 2, 3), axis = normalize(Vec3(1, 2, -1));
  const auto sample = light.sample_direct(position + axis * 3.0f, Vec2(0.5f));
  ASSERT_TRUE(sample);
  EXPECT_NEAR(length(sample->wi + axis), 0, 1e-6f);
  EXPECT_NEAR(sample->weight[0], 10.0f / 9, 1e-5f);
  EXPECT_NEAR(sample->weight[1], 5.0f / 9, 1e-5f);
  EXPECT_FALSE(light.sample_direct(position - axis, Vec2(0.5f))) << "behind";
}

TEST(SpotLight, SendsTheIntegralOfItsIntensity) {
  const std::pair<float, float> angles[] = {{40, 20}, {20, 15}, {30, 30}, {10, 0}, {90, 10}, {180, 120}};
  for (const auto& [cutoff, beam] : angles) {
    const SpotLight light(Transform(), Spectrum(10.0f), cutoff, beam);
    const double cutoff_angle = static_cast<double>(cutoff) * std::numbers::pi / 180;
    const double flux = testing::integrate_interval(
        [&](double theta) {
          const Vec3 w(static_cast<float>(std::sin(theta)), 0, static_cast<float>(std::cos(theta)));
          return 2 * std::numbers::pi * std::sin(theta) * static_cast<double>(light.intensity(w)[0]);
        },
        0, cutoff_angle, 1e-4, 6);
    EXPECT_NEAR(flux, static_cast<double>(light.power()[0]), 2e-3) << cutoff << ' ' << beam;
  }
}

TEST(SpotLight, ProjectsItsTextureOverTheCone) {
  const SpotLight light(Transform(), Spectrum(1.0f), 45, 45, std::make_shared<UvTexture>());
  const auto at = [&](float x, float y) { return light.intensity(normalize(Vec3(x, y, 1))); };
  EXPECT_NEAR(at(0, 0)[0], 0.5f, 1e-6f);
  EXPECT_NEAR(at(0.9f, 0)[0], 0.95f, 1e-6f);
  EXPECT_NEAR(at(0, -0.9f)[1], 0.05f, 1e-6f);
}

TEST(SpotLight, RefusesImpossibleAngles) {
  EXPECT_THROW(SpotLight(Transform(), Spectrum(1.0f), 0, 0), std::invalid_argument);
  EXPECT_THROW(SpotLight(Transform(), Spectrum(1.0f), 20, 30), std::invalid_argument);
  EXPECT_THROW(SpotLight(Transform(), Spectrum(1.0f), 200, 30), std::invalid_argument);
  EXPECT_THROW(SpotLight(Transform(), Spectrum(1.0f), 20, -1), std::invalid_argument);
  EXPECT_THROW(SpotLight(Transform(), Spectrum(1.0f), 90, 30, std::make_shared<UvTexture>()), std::invalid_argument);
}

}  // namespace
}  // namespace turbid
