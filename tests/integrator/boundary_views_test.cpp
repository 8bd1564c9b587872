// What is seen by looking into media from all over their boundaries.
#include "integrator/boundary_views.h"

#include <gtest/gtest.h>

#include "scene/loader.h"
#include "surface/fresnel.h"

namespace turbid::testing {
namespace {

constexpr float kSigmaT = 0.8f, kRadius = 1.5f;

Scene ball_of(const std::string& bsdf, const std::string& inside = "") {
  const std::string ball = R"(<shape type="sphere"><float name="radius" value="1.5"/>)" + bsdf +
                           R"(<medium name="interior" type="homogeneous"><float name="sigma_t" value="0.8"/>
      <rgb name="albedo" value="0.5"/></medium></shape>)";
  return Scene(load_scene_from_string("<scene version=\"3.0.0\"><sensor type=\"perspective\"><transform "
                                      "name=\"to_world\"><lookat origin=\"0,0,9\" target=\"0,0,0\" up=\"0,1,0\"/>"
                                      "</transform></sensor>" +
                                          ball + inside + "</scene>",
                                      "test scene")
                   .parts);
}

/// What leaves the ball, were its source radiance 1 everywhere.
double power_of_even_light(const Scene& scene, bool inner_side = true) {
  const Medium& medium = *scene.media().front().medium;
  std::set<SurfaceSide> sides;
  for (const Object& object : scene.objects()) sides.insert({&object, object.bounds_media != inner_side});
  double sum = 0;
  for (const LeavingPower& l :
       look_into(scene, medium, sides, {{0.1f, 0, 0}, 2}, 100'000, 7,
                 [](const auto&, const PathState&state, Rng&) { return state.throughput / (kSigmaT * 0.5f); })) {
    EXPECT_LE(length(l.scattered), kRadius * 1.0001f);
    EXPECT_NEAR(length(l.direction), 1, 1e-5f);
    sum += static_cast<double>(l.power[0]);
  }
  return sum;
}

// pi A (1 - <e^-sigma c>) / sigma, c the chords of a ball, of density c / 2R^2.
TEST(BoundaryViews, SeeThePowerThatLeavesABall) {
  const double x = 2.0 * kRadius * kSigmaT, area = 4 * std::numbers::pi * 2.25;
  const double passes = 2 * (1 - (1 + x) * std::exp(-x)) / (x * x);
  const double power = std::numbers::pi * area * (1 - passes) / 0.8;
  EXPECT_NEAR(power_of_even_light(ball_of(R"(<bsdf type="null"/>)")) / power, 1, 0.01);
  // Where the boundary bends light, a ray that is let in sees chords of one length, one after the other.
  constexpr double kIndex = 1.5;
  constexpr int kCosines = 2000;
  double seen = 0;
  for (int i = 0; i < kCosines; ++i) {
    const double cosine = (i + 0.5) / kCosines, inside = std::sqrt(1 - (1 - cosine * cosine) / (kIndex * kIndex));
    const auto reflected =
        static_cast<double>(fresnel_dielectric(static_cast<float>(cosine), static_cast<float>(kIndex)).reflectance);
    const double passed = std::exp(-x * inside);
    seen += 2 * cosine / kCosines * (1 - reflected) * (1 - passed) / (1 - reflected * passed);
  }
  const double bent = power_of_even_light(ball_of(
      R"(<bsdf type="dielectric"><float name="int_ior" value="1.5"/><float name="ext_ior" value="1"/></bsdf>)"));
  EXPECT_NEAR(bent / (std::numbers::pi * area * seen / (0.8 * kIndex * kIndex)), 1, 0.01);
  // Sides that nothing leaves by are not looked into.
  EXPECT_EQ(power_of_even_light(ball_of(R"(<bsdf type="null"/>)"), false), 0);
}

// A black ball inside is left into as well: it takes what comes to its surface.
TEST(BoundaryViews, SeeWhatOpaqueSurfacesTake) {
  const std::string black = R"(<shape type="sphere"><float name="radius" value="0.05"/><bsdf type="diffuse">
      <rgb name="reflectance" value="0"/></bsdf></shape>)";
  const Scene scene = ball_of(R"(<bsdf type="null"/>)", black);
  const Medium& medium = *scene.media().front().medium;
  std::set<SurfaceSide> sides;
  for (const Object& object : scene.objects())
    if (!object.bounds_media) sides.insert({&object, true});
  double sum = 0;
  for (const LeavingPower& l :
       look_into(scene, medium, sides, {{0, 0, 0}, 0.06f}, 100'000, 7,
                 [](const auto&, const PathState&state, Rng&) { return state.throughput / (kSigmaT * 0.5f); }))
    sum += static_cast<double>(l.power[0]);
  // From the middle every way out is about the radius long.
  const double radiance = (1 - std::exp(-0.8 * 1.47)) / 0.8;
  EXPECT_NEAR(sum / (std::numbers::pi * 4 * std::numbers::pi * 0.0025 * radiance), 1, 0.03);
}

}  // namespace
}  // namespace turbid::testing
