// Light at infinity: orientation, interpolation, and sampling by the density that is claimed.
#include <gtest/gtest.h>

#include "emitter/constant_environment.h"
#include "emitter/environment_map.h"
#include "testing/chi_square.h"

namespace turbid {
namespace {

/// A map of width x height pixels from a function of (column, row).
template <class F>
EnvironmentMap make_map(int width, int height, F pixel, const Transform& to_world = {}, float scale = 1) {
  std::vector<Spectrum> pixels;
  for (int row = 0; row < height; ++row)
    for (int column = 0; column < width; ++column) pixels.push_back(pixel(column, row));
  return {std::move(pixels), width, height, to_world, scale};
}

/// Random pixels, most of them dark, some bright.
EnvironmentMap noisy_map(int width, int height, const Transform& to_world = {}) {
  Rng rng(11);
  return make_map(
      width, height,
      [&](int, int) {
        const float bright = rng.next_float() < 0.1f ? 20.0f : 0.5f;
        const float r = rng.next_float(), g = rng.next_float();
        return Spectrum(r, g, rng.next_float()) * bright;
      },
      to_world);
}

const Transform kTurned = Transform::rotate(1, 2, 3, 77) * Transform::scale(-2, 2, 2);

std::optional<Vec3> draw(const EnvironmentEmitter& light, Rng& rng) {
  const float x = rng.next_float();
  const auto sample = light.sample_direct(Vec3(0), Vec2(x, rng.next_float()));
  return sample ? std::optional(sample->wi) : std::nullopt;
}

testing::ChiSquareResult test_directions(const EnvironmentEmitter& sampled, const EnvironmentEmitter& claimed) {
  return testing::chi_square_sphere([&](Rng& rng) { return draw(sampled, rng); },
                                    [&](const Vec3& w) { return static_cast<double>(claimed.pdf_direct_w(w)); });
}

TEST(ConstantEnvironment, IsTheSameEverywhere) {
  ConstantEnvironment light(Spectrum(1, 2, 3));
  light.set_scene_bounds(Vec3(1), 2);
  EXPECT_EQ(light.Le(Vec3(0, 0, 1)), Spectrum(1, 2, 3));
  const auto sample = light.sample_direct(Vec3(0), Vec2(0.3f, 0.8f));
  EXPECT_FLOAT_EQ(sample->weight[0], 4 * kPi);
  EXPECT_EQ(sample->distance, kInfinity);
  EXPECT_FLOAT_EQ(light.power()[0], 4 * kPi * kPi * 4);
  EXPECT_TRUE(passes(test_directions(light, light)));
}

TEST(EnvironmentMap, ShowsItsPixelsWhereMitsubaDoes) {
  // Red grows to the right, green downwards: the value at a direction tells its place in the image.
  constexpr int kWidth = 64, kHeight = 33;
  const EnvironmentMap map = make_map(kWidth, kHeight, [](int column, int row) {
    return Spectrum((static_cast<float>(column) + 0.5f) / kWidth, static_cast<float>(row) / (kHeight - 1), 0);
  });
  const auto expect = [&](const Vec3& w, float x, float y) {
    const Spectrum value = map.Le(normalize(w));
    EXPECT_NEAR(value[0], x, 1e-5f);
    EXPECT_NEAR(value[1], y, 1e-5f);
  };
  expect({0, 0, 1}, 0.5f, 0.5f);     // the middle looks along +z
  expect({1, 0, 0}, 0.25f, 0.5f);    // +x is left of it
  expect({-1, 0, 0}, 0.75f, 0.5f);   // -x right
  expect({0, 1, 1}, 0.5f, 0.25f);    // up
  expect({0, -1, 1}, 0.5f, 0.75f);   // down
  expect({1, 0, -1}, 0.125f, 0.5f);  // behind, to the left
  EXPECT_NEAR(map.Le(Vec3(0, 1, 0))[1], 0, 1e-6f);
  EXPECT_NEAR(map.Le(Vec3(0, -1, 0))[1], 1, 1e-6f);
}

TEST(EnvironmentMap, InterpolatesAroundTheCircle) {
  // Behind (-z) lies the seam, half-way between the last column and the first.
  const EnvironmentMap map = make_map(4, 3, [](int column, int) { return Spectrum(column == 0 ? 8.0f : 0.0f); });
  EXPECT_NEAR(map.Le(Vec3(0, 0, -1))[0], 4, 1e-5f);
  EXPECT_NEAR(map.Le(normalize(Vec3(1, 0, -1)))[0], 8, 1e-5f);  // the centre of column 0
  EXPECT_NEAR(map.Le(normalize(Vec3(-1, 0, -1)))[0], 0, 1e-5f);
}

TEST(EnvironmentMap, TurnsWithItsTransform) {
  const EnvironmentMap still = noisy_map(16, 9), turned = noisy_map(16, 9, kTurned);
  Rng rng(3);
  for (int i = 0; i < 100; ++i) {
    const float x = rng.next_float();
    const Vec3 w = square_to_sphere(Vec2(x, rng.next_float()));
    const Vec3 there = normalize(kTurned.vector(w));
    EXPECT_NEAR(turned.Le(there)[0], still.Le(w)[0], 2e-4f);
    EXPECT_NEAR(turned.pdf_direct_w(there), still.pdf_direct_w(w), 2e-4f);
  }
}

TEST(EnvironmentMap, IsSampledAsItSays) {
  const EnvironmentMap maps[] = {
      noisy_map(16, 9),
      noisy_map(16, 9, kTurned),
      noisy_map(5, 2),
      noisy_map(1, 3),
      noisy_map(200, 100),
      make_map(32, 16, [](int column, int row) { return Spectrum(column == 7 && row == 0 ? 1.0f : 0.0f); }),
      make_map(32, 16, [](int column, int row) { return Spectrum(0, 0, column == 31 && row == 9 ? 1.0f : 0.0f); }),
      make_map(3, 4, [](int, int) { return Spectrum(1.0f); })};
  for (const EnvironmentMap& map : maps) {
    const auto result = test_directions(map, map);
    EXPECT_TRUE(passes(result, static_cast<int>(std::size(maps)))) << result.report;
  }
}

TEST(EnvironmentMap, PlantedErrorIsFound) {
  // A density that forgets that rows shrink towards the poles, and one turned the other way round.
  const EnvironmentMap map = noisy_map(16, 9), mirrored = noisy_map(16, 9, Transform::scale(-1, 1, 1));
  EXPECT_FALSE(passes(test_directions(map, mirrored), 100));
  const auto without_sine = [&](const Vec3& w) {
    return static_cast<double>(map.pdf_direct_w(w)) * (std::numbers::pi / 2) * std::hypot(double{w.x}, double{w.z});
  };
  EXPECT_FALSE(passes(testing::chi_square_sphere([&](Rng& rng) { return draw(map, rng); }, without_sine), 100));
}

TEST(EnvironmentMap, SampleAgreesWithEvaluation) {
  const EnvironmentMap map = noisy_map(64, 33, kTurned);
  Rng rng(9);
  for (int i = 0; i < 1000; ++i) {
    const float x = rng.next_float();
    const auto sample = map.sample_direct(Vec3(0), Vec2(x, rng.next_float()));
    ASSERT_TRUE(sample);
    const Spectrum radiance = map.Le(sample->wi);
    const float pdf_w = map.pdf_direct_w(sample->wi);
    EXPECT_NEAR(sample->pdf_w / pdf_w, 1, 5e-3f);  // directions are floats, pixels differ by factors of 40
    for (int c = 0; c < kChannels; ++c)
      EXPECT_NEAR(sample->weight[c] * sample->pdf_w, radiance[c], 5e-3f * (1 + radiance[c]));
  }
}

TEST(EnvironmentMap, SamplesEstimateItsIntegral) {
  for (const EnvironmentMap& map : {noisy_map(16, 9), noisy_map(40, 3)}) {
    const double exact =
        testing::integrate_sphere([&](const Vec3& w) { return static_cast<double>(map.Le(w)[1]); }, 1e-3);
    constexpr int kSide = 512;
    double sum = 0;
    for (int i = 0; i < kSide * kSide; ++i) {
      const Vec2 u((static_cast<float>(i % kSide) + 0.5f) / kSide, (static_cast<float>(i / kSide) + 0.5f) / kSide);
      sum += static_cast<double>(map.sample_direct(Vec3(0), u)->weight[1]);
    }
    EXPECT_NEAR(sum / (kSide * kSide) / exact, 1, 2e-3);
  }
}

TEST(EnvironmentMap, SendsItsIntegralThroughTheScene) {
  EnvironmentMap map = make_map(
      8, 5, [](int, int) { return Spectrum(1, 2, 0); }, {}, 3);
  map.set_scene_bounds(Vec3(0), 2);
  EXPECT_FLOAT_EQ(map.Le(Vec3(0, 0, 1))[0], 3);
  EXPECT_FLOAT_EQ(map.power()[0], 3 * 4 * kPi * kPi * 4);
  EXPECT_FLOAT_EQ(map.power()[1], 6 * 4 * kPi * kPi * 4);
  EXPECT_EQ(map.power()[2], 0);
}

TEST(EnvironmentMap, BlackMapsGiveNoSamples) {
  const EnvironmentMap map = make_map(4, 4, [](int, int) { return Spectrum(); });
  EXPECT_FALSE(map.sample_direct(Vec3(0), Vec2(0.5f)));
  EXPECT_EQ(map.pdf_direct_w(Vec3(0, 0, 1)), 0);
}

TEST(EnvironmentMap, RefusesBadImages) {
  const std::vector<Spectrum> good(4, Spectrum(1.0f));
  EXPECT_THROW(EnvironmentMap(good, 4, 1, {}, 1), std::invalid_argument);
  EXPECT_THROW(EnvironmentMap(good, 2, 3, {}, 1), std::invalid_argument);
  EXPECT_THROW(EnvironmentMap(good, 2, 2, {}, -1), std::invalid_argument);
  EXPECT_THROW(EnvironmentMap(good, 2, 2, Transform::scale(1, 2, 1), 1), std::invalid_argument);
  std::vector<Spectrum> bad = good;
  bad[2][1] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW(EnvironmentMap(bad, 2, 2, {}, 1), std::invalid_argument);
}

}  // namespace
}  // namespace turbid
