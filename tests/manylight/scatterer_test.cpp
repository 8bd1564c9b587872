// What virtual lights send: the quick forms against the vertices they stand for.
#include "manylight/scatterer.h"

#include <gtest/gtest.h>

#include "core/warp.h"
#include "manylight/lights_for_tests.h"
#include "manylight/volume_points.h"
#include "testing/chi_square.h"

namespace turbid::testing {
namespace {

TEST(Scatterer, IsItsVertex) {
  FoggyBox box;
  Rng rng(1);
  int seen[2] = {0, 0};
  for (const TransportMode mode : {TransportMode::kImportance, TransportMode::kRadiance})
    for (const Scatterer& light : box.lights.points()) {
      const Scatterer end(light.vertex(), mode);
      for (int i = 0; i < 20; ++i) {
        const float u = rng.next_float();
        const Vec3 direction = square_to_sphere({u, rng.next_float()});
        const Spectrum expected = light.vertex().throughput * light.vertex().scattered(direction, mode);
        const Spectrum found = end.towards(direction);
        for (int c = 0; c < kChannels; ++c) EXPECT_NEAR(found[c], expected[c], 1e-5f * (expected[c] + 1e-3f));
        ++seen[expected.is_black()];
      }
    }
  EXPECT_GT(seen[0], 1000);
  EXPECT_GT(seen[1], 100);
}

TEST(Scatterer, SeesNothingBeyondTheDepth) {
  FoggyBox box;
  const Scatterer& a = box.lights.points()[0];
  const Scatterer place(a.vertex(), TransportMode::kRadiance);
  for (const Scatterer& light : box.lights.points()) {
    LineSettings lines;
    if (unshadowed(place, light, lines).is_black()) continue;
    lines.max_depth = place.depth() + 1 + light.depth();
    EXPECT_FALSE(unshadowed(place, light, lines).is_black());
    --lines.max_depth;
    EXPECT_TRUE(unshadowed(place, light, lines).is_black());
  }
}

/// Light from a virtual light, and its sum over all, do not depend on threads or on other sets.
TEST(VirtualLights, DependOnTheirSetAlone) {
  const FoggyBox one, two;
  ASSERT_EQ(one.lights.size(), two.lights.size());
  for (size_t i = 0; i < one.lights.size(); ++i)
    EXPECT_EQ(one.lights.points()[i].position(), two.lights.points()[i].position());
  FoggyBox other;
  const VirtualLights next({other.scene, other.sources, other.settings, 7}, 40, 1, other.counters);
  ASSERT_FALSE(next.empty());
  EXPECT_NE(next.points()[0].position(), one.lights.points()[0].position());
}

TEST(VirtualLights, ComeAboutAsManyAsAskedFor) {
  FoggyBox box;
  const VirtualLightPlan plan{box.scene, box.sources, box.settings, 3};
  const size_t paths = paths_for_lights(plan, 20'000);
  EXPECT_EQ(paths, paths_for_lights(plan, 20'000));
  const VirtualLights lights(plan, paths, 0, box.counters);
  EXPECT_NEAR(static_cast<double>(lights.size()), 20'000, 2'000);
}

TEST(VolumePoints, FollowTheirDensity) {
  const auto phase = load_scene_from_string(R"(<scene version="3.0.0"><sensor type="perspective"/>
    <shape type="sphere"><medium name="interior" type="homogeneous"><rgb name="sigma_t" value="0.1, 0.7, 2"/>
    <rgb name="albedo" value="0.5"/></medium></shape></scene>)",
                                            "medium", {});
  const HomogeneousMedium& medium = *phase.parts.objects[0].interior->as_homogeneous();
  const Spectrum mix(0.2f, 0.5f, 0.3f);
  const float length = 3;
  const auto pdf_at = [&](double t) {
    double pdf = 0;
    for (int c = 0; c < kChannels; ++c) {
      const auto sigma = static_cast<double>(medium.sigma_t()[c]);
      pdf += static_cast<double>(mix[c]) * sigma * std::exp(-sigma * t) /
             -std::expm1(-sigma * static_cast<double>(length));
    }
    return pdf;
  };
  const auto sample = [&](Rng& rng) -> std::optional<double> {
    const MadeDistance made = collide_before(medium, length, mix, rng.next_float());
    EXPECT_NEAR(static_cast<double>(made.pdf_t), pdf_at(static_cast<double>(made.t)), 1e-4);
    return static_cast<double>(made.t);
  };
  const ChiSquareResult right = chi_square_interval(sample, pdf_at, 0, 3);
  EXPECT_TRUE(passes(right)) << right.report;
  EXPECT_FALSE(passes(chi_square_interval(
      sample, [&](double t) { return pdf_at(t) * (1.05 - t / 30); }, 0, 3)));
}

}  // namespace
}  // namespace turbid::testing
