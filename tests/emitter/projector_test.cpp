// A projector: irradiance on a screen, power, what it refuses.
#include "emitter/projector.h"

#include <gtest/gtest.h>

#include "testing/chi_square.h"
#include "texture/bitmap.h"
#include "texture/constant.h"

namespace turbid {
namespace {

const Transform kSlanted = Transform::look_at({1, 2, 3}, {2, 4, 2}, {0, 0, 1});

/// Radiance colours by uv, to see where the picture is looked up.
class UvTexture final : public Texture {
 public:
  Spectrum eval(const SurfacePoint& point) const override { return {point.uv.x, point.uv.y, 1}; }
  Spectrum mean() const override { return {0.5f, 0.5f, 1}; }
  float max() const override { return 1; }
};

/// Irradiance over pi on a plane across the axis, at (x, y, z) of the projector's space.
Spectrum on_screen(const Projector& projector, const Transform& to_world, const Vec3& p) {
  const auto sample = projector.sample_direct(to_world.point(p), Vec2(0));
  if (!sample) return Spectrum();
  return sample->weight * (std::abs(dot(sample->wi, to_world.vector(Vec3(0, 0, 1)))) * kInvPi);
}

TEST(Projector, ShowsAConstantPictureEvenly) {
  const Projector projector(kSlanted, std::make_shared<ConstantTexture>(Spectrum(1, 2, 3)), 4, 60, 1.5);
  const float x = std::tan(kPi / 6), y = x / 1.5f;
  for (const Vec2& at : {Vec2(0, 0), Vec2(0.9f, 0.9f), Vec2(-0.99f, 0.5f), Vec2(0.3f, -0.99f)}) {
    const Spectrum near = on_screen(projector, kSlanted, {at.x * x, at.y * y, 1});
    const Spectrum far = on_screen(projector, kSlanted, {2 * at.x * x, 2 * at.y * y, 2});
    for (int c = 0; c < kChannels; ++c) {
      EXPECT_NEAR(near[c], 4 * static_cast<float>(c + 1), 1e-4f);
      EXPECT_NEAR(far[c], static_cast<float>(c + 1), 1e-4f);
    }
  }
  for (const Vec3& outside : {Vec3(1.01f * x, 0, 1), Vec3(0, -1.01f * y, 1), Vec3(0, 0, -1)})
    EXPECT_TRUE(on_screen(projector, kSlanted, outside).is_black());
  EXPECT_FALSE(projector.sample_direct(Vec3(1, 2, 3), Vec2(0))) << "at the projector itself";
}

TEST(Projector, TurnsThePictureAsACameraSeesIt) {
  // +x is the left of the picture, +y its top.
  const Projector projector({}, std::make_shared<UvTexture>(), 1, 90, 2);
  const Spectrum top_left = on_screen(projector, {}, {0.8f, 0.4f, 1});
  EXPECT_NEAR(top_left[0], 0.1f, 1e-5f);
  EXPECT_NEAR(top_left[1], 0.1f, 1e-5f);
  const Spectrum bottom = on_screen(projector, {}, {0, -0.25f, 1});
  EXPECT_NEAR(bottom[0], 0.5f, 1e-5f);
  EXPECT_NEAR(bottom[1], 0.75f, 1e-5f);
}

TEST(Projector, SendsItsPower) {
  const Projector projector({}, std::make_shared<UvTexture>(), 2, 70, 1.2);
  const double flux = testing::integrate_sphere(
      [&](const Vec3& p) {
        const auto sample = projector.sample_direct(p, Vec2(0));
        return sample ? static_cast<double>(sample->weight[0]) : 0.0;
      },
      1e-4);
  EXPECT_NEAR(flux, static_cast<double>(projector.power()[0]), 1e-2 * flux);
  const auto sample = projector.sample_direct(Vec3(0, 0, 2), Vec2(0));
  ASSERT_TRUE(sample);
  EXPECT_TRUE(sample->delta);
  EXPECT_EQ(sample->pdf_w, 0);
  EXPECT_EQ(sample->distance, 2);
  EXPECT_EQ(sample->wi, Vec3(0, 0, -1));
  EXPECT_FALSE(projector.can_be_hit());
}

/// Every sample's flux is what the intensity says, times the solid angle that it stands for.
TEST(Projector, SendsRaysThroughThePicture) {
  const Projector projector(kSlanted, std::make_shared<UvTexture>(), 2, 70, 1.2);
  double power = 0;
  constexpr int kSide = 40;
  for (int i = 0; i < kSide * kSide; ++i) {
    const Vec2 u((static_cast<float>(i % kSide) + 0.5f) / kSide, (static_cast<float>(i / kSide) + 0.5f) / kSide);
    const auto ray = projector.sample_emission(Vec2(0.5f), u);
    ASSERT_TRUE(ray);
    EXPECT_EQ(ray->origin, Vec3(1, 2, 3));
    EXPECT_NEAR(length(ray->direction), 1, 1e-5f);
    const Spectrum expected = projector.intensity(ray->direction) / Spectrum(ray->pdf.pdf_w);
    EXPECT_NEAR(ray->weight[0], expected[0], 1e-4f * expected[2]);
    EXPECT_NEAR(ray->weight[1], expected[1], 1e-4f * expected[2]);
    power += static_cast<double>(ray->weight[0]) / (kSide * kSide);
  }
  EXPECT_NEAR(power, static_cast<double>(projector.power()[0]), 1e-3 * power);
}

TEST(Projector, RefusesWhatMakesNoPicture) {
  const auto white = std::make_shared<ConstantTexture>(1.0f);
  EXPECT_THROW(Projector({}, nullptr, 1, 60, 1), std::invalid_argument);
  EXPECT_THROW(Projector({}, white, 1, 180, 1), std::invalid_argument);
  EXPECT_THROW(Projector({}, white, 1, 60, 0), std::invalid_argument);
  EXPECT_THROW(Projector(Transform::scale(2, 2, 2), white, 1, 60, 1), std::invalid_argument);
}

}  // namespace
}  // namespace turbid
