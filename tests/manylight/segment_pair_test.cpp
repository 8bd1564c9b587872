// Places on segments, drawn for virtual ray lights: samples against densities, and densities against what they stand
// for.
#include "manylight/segment_pair.h"

#include <gtest/gtest.h>

#include "core/warp.h"
#include "manylight/lanes.h"
#include "manylight/segment_pairs.h"
#include "testing/chi_square.h"

namespace turbid::testing {
namespace {

Vec3 random_direction(Rng& rng) {
  const float u = rng.next_float();
  return square_to_sphere({u, rng.next_float()});
}
Vec3 random_point(Rng& rng, float scale) {
  const Vec3 direction = random_direction(rng);
  return direction * (scale * rng.next_float());
}
struct Segments {
  Ray light, sensor;
  SegmentLobes lobes;
};
/// Segments as they come: crossing, far apart, nearly parallel, on one line.
std::vector<Segments> some_segments() {
  std::vector<Segments> result;
  Rng rng(4);
  for (int i = 0; i < 7; ++i) {
    Segments segments;
    segments.light = {random_point(rng, 2), random_direction(rng), 0.1f + 2 * rng.next_float()};
    segments.sensor = {random_point(rng, 2), random_direction(rng), 0.5f + 3 * rng.next_float()};
    if (i == 3) segments.sensor.direction = normalize(segments.light.direction + random_direction(rng) * 1e-3f);
    if (i == 4)
      segments.sensor = {segments.light.origin - segments.light.direction * 3.0f, segments.light.direction, 1.5f};
    if (i == 5) segments.light.origin += segments.light.direction * 50.0f;
    if (i % 3 == 1) segments.lobes = {0.9f, 0.9f};
    if (i % 3 == 2) segments.lobes = {-0.4f, 0.7f};
    result.push_back(segments);
  }
  return result;
}

TEST(SegmentPair, PlacesFollowTheirDensity) {
  const auto all = some_segments();
  for (const Segments& segments : all) {
    const Ray& sensor = segments.sensor;
    const Vec3 p = segments.light.origin;
    const auto pdf = [&](double t) { return pdf_towards(sensor, p, segments.lobes.g_sensor, static_cast<float>(t)); };
    const auto sample = [&](Rng& rng) -> std::optional<double> {
      const PlaceOnSegment place = place_towards(sensor, p, segments.lobes.g_sensor, rng.next_float());
      return static_cast<double>(place.t);
    };
    const ChiSquareResult result = chi_square_interval(sample, pdf, 0, static_cast<double>(sensor.t_max));
    EXPECT_TRUE(passes(result, static_cast<int>(all.size()))) << result.report;
    const auto wrong = [&](double t) { return pdf(t) * (1.1 - 0.2 * t / static_cast<double>(sensor.t_max)); };
    EXPECT_LT(chi_square_interval(sample, wrong, 0, static_cast<double>(sensor.t_max)).p_value, result.p_value);
  }
}

TEST(SegmentPair, PairsFollowTheirDensity) {
  const auto all = some_segments();
  int noticed = 0;
  for (const Segments& segments : all) {
    const float light = segments.light.t_max, sensor = segments.sensor.t_max;
    const auto sample = [&](Rng& rng) -> std::optional<Vec2> {
      const float u = rng.next_float();
      const SegmentPair pair = sample_pair(segments.light, segments.sensor, segments.lobes, {u, rng.next_float()});
      return Vec2(std::min(pair.on_light / light, 0x1.fffffep-1f), std::min(pair.on_sensor / sensor, 0x1.fffffep-1f));
    };
    const auto pdf = [&](const Vec2& x) {
      return pdf_pair(segments.light, segments.sensor, segments.lobes, x.x * light, x.y * sensor) *
             static_cast<double>(light * sensor);
    };
    ChiSquareSettings settings;
    settings.samples = 20'000;
    settings.theta_bins = 8;
    settings.phi_bins = 16;
    const ChiSquareResult result = chi_square_square(sample, pdf, settings);
    EXPECT_TRUE(passes(result, static_cast<int>(all.size()))) << result.report;
    noticed += !passes(chi_square_square(
        sample, [&](const Vec2& x) { return pdf(x) * static_cast<double>(1.1f - 0.2f * x.x); }, settings));
  }
  EXPECT_EQ(noticed, static_cast<int>(all.size())) << "errors of a tenth";
}

TEST(SegmentPair, SayTheSameOfWhatTheyDraw) {
  Rng rng(5);
  for (const Segments& segments : some_segments())
    for (int i = 0; i < 200; ++i) {
      const float u = rng.next_float();
      const SegmentPair pair = sample_pair(segments.light, segments.sensor, segments.lobes, {u, rng.next_float()});
      ASSERT_GT(pair.pdf, 0);
      // Next to the border of two strata rounding may put a place on the other side.
      const auto near_border = [&](float shift) {
        return pdf_pair(segments.light, segments.sensor, segments.lobes, pair.on_light * (1 + shift), pair.on_sensor);
      };
      const double told = pdf_pair(segments.light, segments.sensor, segments.lobes, pair.on_light, pair.on_sensor);
      if (std::abs(near_border(1e-4f) / near_border(-1e-4f) - 1) > 0.02) continue;
      EXPECT_NEAR(told / pair.pdf, 1, 0.6) << i;
    }
}

/// The vector form draws the same places with the same densities; where strata meet, rounding may choose another.
TEST(SegmentPairs, AreTheirTwin) {
  Rng rng(7);
  for (const SegmentLobes& lobes : {SegmentLobes{0, 0}, SegmentLobes{0.9f, 0.9f}, SegmentLobes{-0.4f, 0.7f}}) {
    const auto all = some_segments();
    int elsewhere = 0, count = 0;
    for (const Segments& sensor : all)
      for (int round = 0; round < 200; ++round) {
        std::vector<PairRequest> requests;
        for (const Segments& light : all) {
          const float u = rng.next_float();
          requests.push_back({&light.light, lobes.g_light, {u, rng.next_float()}});
        }
        std::vector<SegmentPair> found(requests.size());
        sample_pairs(requests, sensor.sensor, lobes.g_sensor, found);
        for (size_t i = 0; i < requests.size(); ++i, ++count) {
          const Ray& light = *requests[i].light;
          const SegmentPair twin = sample_pair(light, sensor.sensor, lobes, requests[i].u);
          const bool same = std::abs(found[i].on_light - twin.on_light) < 1e-3f * light.t_max &&
                            std::abs(found[i].on_sensor - twin.on_sensor) < 2e-3f * sensor.sensor.t_max &&
                            std::abs(found[i].pdf / twin.pdf - 1) < 0.01;
          elsewhere += !same;
        }
      }
    EXPECT_LT(elsewhere, count / 500) << "of " << count;
  }
}

TEST(SegmentPairs, VectorFunctionsAreExact) {
  for (float x = -20; x < 20; x += 0.0371f) {
    EXPECT_NEAR(exp_lanes(x)[0] / std::exp(x), 1, 3e-7f) << x;
    const float positive = std::exp(x), angle = (x + 20) / 40 * kPi;
    EXPECT_NEAR(log_lanes(positive)[0], std::log(positive), 2e-6f) << x;
    EXPECT_NEAR(inverse_sqrt_lanes(positive)[0] * std::sqrt(positive), 1, 5e-7f) << x;
    EXPECT_NEAR(sine_cosine_lanes(angle).sine[0], std::sin(angle), 2e-7f) << x;
    const float small = std::exp(-std::abs(x));
    EXPECT_NEAR(sine_cosine_lanes(small).sine[0] / std::sin(small), 1, 5e-7f) << x;
    EXPECT_NEAR(angle_lanes(small, 1)[0] / std::atan(small), 1, 5e-7f) << x;
    EXPECT_NEAR(sine_cosine_lanes(angle).cosine[0], std::cos(angle), 2e-7f) << x;
    EXPECT_NEAR(angle_lanes(std::sin(angle), std::cos(angle))[0], angle, 5e-7f) << x;
    EXPECT_NEAR(angle_lanes(7 * std::sin(angle), 7 * std::cos(angle))[0], angle, 5e-7f) << x;
  }
}

/// 1/d^2 over the density hardly varies where there are no lobes, however near the segments come.
TEST(SegmentPair, TakesUpTheInverseSquare) {
  Rng rng(6);
  for (int i = 0; i < 50; ++i) {
    const Ray light{random_point(rng, 0.02f) - Vec3(0.5f, 0, 0), Vec3(1, 0, 0), 1};
    const Ray sensor{random_point(rng, 0.02f) - Vec3(0, 0.5f, 0), Vec3(0, 1, 0), 1};
    double sum = 0, squares = 0;
    constexpr int kSamples = 2000;
    for (int k = 0; k < kSamples; ++k) {
      const float u = rng.next_float();
      const SegmentPair pair = sample_pair(light, sensor, {}, {u, rng.next_float()});
      const double value =
          1 / (static_cast<double>(length_squared(light.at(pair.on_light) - sensor.at(pair.on_sensor))) * pair.pdf);
      sum += value / kSamples;
      squares += value * value / kSamples;
    }
    EXPECT_LT(std::sqrt(squares - sum * sum) / sum, 0.35);
  }
}

}  // namespace
}  // namespace turbid::testing
