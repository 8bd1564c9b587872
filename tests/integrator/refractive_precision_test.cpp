// Single scattering through smooth meshes to a percent and less, under lamps of a tenth of the body's size and under
// point lights. Paths are cut after the one edge to the light behind the boundary: then order 1 is what is followed and
// nothing else, so that all samples of the other integrator go into it. Where the sensor stands in the medium light
// tracing is that other one: it crosses the boundary on its way, and joins V with the sensor. Else paths meet the lamp.
#include <gtest/gtest.h>

#include "core/parallel.h"
#include "integrator/refractive_scenes.h"

namespace turbid::testing {
namespace {

using namespace pieces;

struct Precision {
  std::string name, xml;
  int max_depth;  ///< edges from the sensor to the light, the flight to V behind a boundary or not
  std::string reference;
  uint32_t samples, followed_samples;  ///< per pass
  double largest_error;                ///< of the mean ratio

  friend void PrintTo(const Precision& precision, std::ostream* out) { *out << precision.name; }
};

constexpr float kSmall = 0.09f;  ///< radius of lamps: a tenth of that of the bodies

std::string in_fog(const std::string& inside) {
  return fog_around() + inside + bumpy(kGlass + R"(<ref name="exterior" id="fog"/>)");
}

/// Sensor and collision on the same side of the boundary, the lamp on the other.
std::vector<Precision> seen_from_within(uint32_t effort, double largest_error) {
  const std::string far = lamp("0.8, 0.9, 3", kSmall, "3000, 4000, 5000"),
                    near = lamp("0.2, 0.1, 1.1", kSmall, "300, 400, 500");
  const std::string point = R"(<emitter type="point"><point name="position" value="0.8, 0.9, 3"/>
    <rgb name="intensity" value="30, 40, 50"/></emitter>)";
  const std::string murky = kGlass + clear();
  const auto by_light = [&](const std::string& name, const std::string& xml, uint32_t samples, uint32_t followed) {
    return Precision{name, xml, 3, "ptracer", samples * effort, followed * effort, largest_error};
  };
  return {by_light("bumpy_sphere", scene(far + bumpy(murky), "", camera_inside(0.3f)), 48, 1),
          by_light("bumpy_sphere_point_light", scene(point + bumpy(murky), "", camera_inside(0.3f)), 48, 1),
          by_light("sphere", scene(far + sphere(murky), "", camera_inside(0.3f)), 48, 1),
          by_light("slab", scene(far + slab(murky), "", camera_inside(0.3f)), 48, 8),
          by_light("uneven_bumpy_sphere", scene(far + bumpy(kGlass + uneven()), "", camera_inside(0.3f)), 48, 2),
          by_light("lamp_in_glass", scene(in_fog(near), "", kPinholeInMedium), 8, 1)};
}

/// The sensor outside of the body, the lamp too: paths meet it by chance.
std::vector<Precision> seen_from_without(double largest_error) {
  const std::string far = lamp("0.8, 0.9, 3", kSmall, "3000, 4000, 5000");
  const std::string murky = kGlass + clear();
  const auto by_chance = [&](const std::string& name, const std::string& body, uint32_t followed) {
    return Precision{name, scene(far + body), 4, "volpath", 294912, followed, largest_error};
  };
  return {by_chance("sphere", sphere(murky), 512), by_chance("bumpy_sphere", bumpy(murky), 512),
          by_chance("slab", slab(murky), 1024),
          by_chance("coarse_glass", octahedron("<scale value=\"0.9\"/><translate z=\"1\"/>", murky), 1024),
          by_chance("uneven_bumpy_sphere", bumpy(kGlass + uneven()), 512)};
}

/// Passes side by side: a picture of one tile has no other use for threads.
PassStatistics observe(const Precision& p, const std::string& integrator, uint32_t samples, uint64_t seed, int block,
                       double brightness = 1) {
  std::vector<Film> films(kPasses);
  std::vector<Counters> counters(kPasses);
  parallel_for(kPasses, [&](size_t pass) {
    Rendering rendering(p.xml, integrator,
                        {{"min_scattering", "1"}, {"max_scattering", "1"}, {"max_depth", std::to_string(p.max_depth)}});
    films[pass] = rendering.pass(seed, static_cast<uint32_t>(pass), samples);
    counters[pass] = rendering.counters();
  });
  PassStatistics result({16, 16}, block);
  uint64_t unresolved = 0, followed = 0;
  for (size_t pass = 0; pass < kPasses; ++pass) {
    for (size_t i = 0; i < films[pass].pixel_count(); ++i)
      for (size_t c = 0; c < kChannels; ++c) films[pass].pixel(i).radiance[c] *= brightness;
    result.add(films[pass]);
    EXPECT_EQ(counters[pass]["dropped_samples"], 0u);
    unresolved += counters[pass]["unresolved_triangles"];
    followed += counters[pass]["refractive_paths"];
  }
  // Light that the solver gives up on is rare, next to the critical angle, too.
  constexpr double kLeftOut = 2e-3;
  EXPECT_LE(static_cast<double>(unresolved), kLeftOut * static_cast<double>(followed));
  return result;
}

void expect_precise(const Precision& p, int block) {
  const PassStatistics reference = observe(p, p.reference, p.samples, 1, block);
  const Verdict verdict = compare_light(reference, observe(p, "singlescatter", p.followed_samples, 2, block));
  std::printf("%-28s ratio %.4f +- %.4f (%s %.4f, singlescatter %.4f), worst |z| %.2f of %zu blocks\n", p.name.c_str(),
              verdict.ratio, verdict.error, p.reference.c_str(), verdict.errors[0], verdict.errors[1],
              verdict.blocks.worst_z, reference.block_count());
  constexpr double kComparisons = 6;
  EXPECT_TRUE(verdict.accepted(kComparisons));
  EXPECT_LT(verdict.error, p.largest_error) << "too noisy to say anything";
  const PassStatistics planted = observe(p, "singlescatter", p.followed_samples, 2, block, 1 + 6 * p.largest_error);
  EXPECT_FALSE(compare_light(reference, planted).accepted(kComparisons)) << "would not see an error";
}

class RefractivePrecision : public ::testing::TestWithParam<Precision> {};
TEST_P(RefractivePrecision, SeenFromWithin) { expect_precise(GetParam(), 8); }
INSTANTIATE_TEST_SUITE_P(Scenes, RefractivePrecision, ::testing::ValuesIn(seen_from_within(1, 0.045)),
                         [](const auto& instance) { return instance.param.name; });

class SlowRefractivePrecision : public ::testing::TestWithParam<Precision> {};
TEST_P(SlowRefractivePrecision, Agrees) { expect_precise(GetParam(), 16); }
INSTANTIATE_TEST_SUITE_P(SlowFromWithin, SlowRefractivePrecision, ::testing::ValuesIn(seen_from_within(24, 0.008)),
                         [](const auto& instance) { return instance.param.name; });
INSTANTIATE_TEST_SUITE_P(SlowFromWithout, SlowRefractivePrecision, ::testing::ValuesIn(seen_from_without(0.01)),
                         [](const auto& instance) { return instance.param.name; });

}  // namespace
}  // namespace turbid::testing
