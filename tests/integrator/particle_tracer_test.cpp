// `ptracer` against `volpath`: the same light followed from its other end. Two-estimator z-tests over passes, in blocks
// of 4 x 4 pixels (NUMERICS 10).
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "integrator/agreement.h"
#include "integrator/suite.h"

namespace turbid::testing {
namespace {

using namespace pieces;

struct Effort {
  uint32_t volpath = 16, ptracer = 32;  ///< samples per pass
};

void expect_same(const std::string& xml, const Effort& effort = {}) {
  // Few paths meet the edge of a lamp or cross a glass: large blocks.
  expect_agreement(xml, {"volpath", effort.volpath, 1, 1}, {"ptracer", effort.ptracer, 1, 2}, 0.05, 8);
}

const std::string kShort = integer("max_depth", 5);

TEST(ParticleTracer, LampOverDiffuseFloor) { expect_same(scene(kLamp + kFloor, kShort)); }

TEST(ParticleTracer, HarnessNoticesAPlantedError) {
  const std::string xml = scene(kLamp + kFloor, kShort);
  EXPECT_FALSE(compare(observe(xml, {"volpath", 16}), observe(xml, {"ptracer", 32, 1.03})).accepted());
}

TEST(ParticleTracer, LongPathsWithRussianRoulette) {
  expect_same(scene(kLamp + kFloor + fog(), integer("rr_depth", 2)), {64, 128});
}

TEST(ParticleTracer, LampInFog) { expect_same(scene(kLamp + kFloor + fog(), kShort), {64, 128}); }

TEST(ParticleTracer, ChromaticMedium) { expect_same(scene(kLamp + fog(2.2f, "0.1, 0.6, 2.5"), kShort)); }

TEST(ParticleTracer, HeterogeneousMedium) {
  const std::string smoke = R"(<bsdf type="null"/><medium name="interior" type="heterogeneous">
    <volume name="sigma_t" type="constvolume"><rgb name="value" value="0.3, 0.6, 0.9"/>
    <transform name="to_world"><scale value="2.5"/><translate x="-1.2" y="-1.2" z="-0.5"/></transform></volume>
    <volume name="albedo" type="constvolume"><rgb name="value" value="0.9, 0.8, 0.7"/></volume></medium>)";
  expect_same(scene(kLamp + kFloor + ball("0, 0, 0.5", 2.2f, smoke), kShort));
}

TEST(ParticleTracer, RoughGlassInFrontOfALamp) {
  const std::string pane = R"(<shape type="sphere"><point name="center" value="0.2, -0.8, 1"/>
    <float name="radius" value="0.9"/><bsdf type="roughdielectric"><float name="alpha" value="0.4"/>
    <float name="int_ior" value="1.5"/></bsdf></shape>)";
  expect_same(scene(kLamp + kFloor + pane, integer("max_depth", 4)), {64, 64});
}

TEST(ParticleTracer, SpotLight) { expect_same(scene(kSpot + kFloor + fog(1.5f), kShort)); }

TEST(ParticleTracer, SkyAndSun) {
  expect_same(scene(kSky + kFloor + fog(1.5f), kShort));
  expect_same(scene(kSun + kFloor + fog(1.5f), kShort));
}

TEST(ParticleTracer, ThinLens) {
  expect_same(scene(kLamp + kFloor, kShort, kThinLens));
  expect_same(scene(kLamp + fog(), kShort, kThinLens), {64, 128});
}

TEST(ParticleTracer, Orthographic) {
  const std::string parallel = R"(<sensor type="orthographic"><transform name="to_world"><scale x="2" y="2"/>
    <lookat origin="0, -6, 2" target="0, 0, 0.5" up="0, 0, 1"/></transform>)" +
                               kFilm + "</sensor>";
  expect_same(scene(kLamp + kFloor + fog(1.5f), kShort, parallel));
}

TEST(ParticleTracer, SensorInsideTheMedium) {
  const std::string around =
      ball("0, 0, 0", 9, R"(<bsdf type="null"/>)" + medium("interior", "0.1, 0.15, 0.2", "0.9, 0.9, 0.9"));
  expect_same(scene(kLamp + kFloor + around, kShort, kPinholeInMedium));
}

TEST(ParticleTracer, MediumWithoutEnd) {
  const std::string clipped = R"(<sensor type="perspective"><float name="fov" value="45"/>
    <float name="near_clip" value="2"/>)" +
                              medium("medium", "0.03, 0.05, 0.08", "0.9, 0.9, 0.9") + R"(
    <transform name="to_world"><lookat origin="0, -6, 2" target="0, 0, 0.5" up="0, 0, 1"/></transform>)" +
                              kFilm + "</sensor>";
  expect_same(scene(kLamp + kFloor, integer("max_depth", 4), clipped));
  expect_same(scene(kSky + kFloor, integer("max_depth", 3), clipped), {16, 128});
}

TEST(ParticleTracer, PrioritiesAndWorldMedium) {
  const std::string world = medium("world", "0.05, 0.05, 0.05", "0.9, 0.9, 0.9");
  expect_same(scene(kLamp + kFloor + fog(1.5f) + world, integer("max_depth", 4), kPinholeInMedium));
}

TEST(ParticleTracer, SensorAndLightFarFromAllShapesInTheWorldMedium) {
  const std::string world =
      ball("0, 0, 0.5", 0.3f, R"(<bsdf type="diffuse"/>)") + medium("world", "0.1, 0.1, 0.1", "0.9, 0.9, 0.9");
  const std::string far_point = R"(<emitter type="point"><point name="position" value="0, 12, 4"/>
    <rgb name="intensity" value="90"/></emitter>)";
  expect_same(scene(kSun + world, integer("max_depth", 3), kPinholeInMedium), {16, 256});
  expect_same(scene(far_point + world, integer("max_depth", 3), kPinholeInMedium), {64, 256});
}

TEST(ParticleTracer, MeshWithStronglyVaryingNormals) {
  const auto solid = [&](const std::string& bsdf) {
    return octahedron(R"(<rotate z="1" angle="20"/><translate x="-0.4" y="-1" z="1"/>)", bsdf);
  };
  expect_same(scene(kLamp + kFloor + solid(R"(<bsdf type="diffuse"/>)"), kShort), {32, 64});
  expect_same(
      scene(kLamp + kFloor + solid(R"(<bsdf type="roughconductor"><float name="alpha" value="0.4"/></bsdf>)"), kShort),
      {32, 64});
}

// Specular refraction by shading normals on the way from the lamp to the floor; the sensor sees the floor alone.
TEST(ParticleTracer, GlassWithStronglyVaryingNormals) {
  const std::string down = R"(<sensor type="perspective"><float name="fov" value="40"/>
    <transform name="to_world"><lookat origin="0.3, -1.2, 0.5" target="0.3, 0.2, 0" up="0, 0, 1"/></transform>)" +
                           kFilm + "</sensor>";
  const std::string glass =
      octahedron(R"(<scale value="0.5"/><rotate z="1" angle="20"/><translate x="0.3" y="0.2" z="1.05"/>)",
                 R"(<bsdf type="dielectric"><float name="int_ior" value="1.4"/></bsdf>)");
  expect_same(scene(kLamp + kFloor + glass, integer("max_depth", 6), down), {512, 128});
}

TEST(ParticleTracer, FilterAndCropOfTheFilm) { expect_same(scene(kLamp + kFloor, kShort, kCropped)); }

TEST(ParticleTracer, HidesEmitters) {
  expect_same(scene(kLamp + kFloor, kShort + R"(<boolean name="hide_emitters" value="true"/>)"));
}

TEST(ParticleTracer, GivesTheSameBitsForAnyNumberOfThreads) {
  const std::string xml = scene(kLamp + kFloor + fog(), kShort);
  const auto render = [&](size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    LoadedScene loaded = load_scene_from_string(xml, "test scene", {});
    const auto replaced = replace_integrator(loaded.integrator, "ptracer", {});
    const IntegratorSetup setup = make_integrator(replaced.description, loaded.document.get());
    return render_with(Scene(std::move(loaded.parts)), *setup.integrator, 8);
  };
  const Film one = render(1);
  for (const size_t threads : {size_t{2}, size_t{7}}) {
    const Film many = render(threads);
    for (size_t i = 0; i < one.pixel_count(); ++i)
      for (size_t c = 0; c < kChannels; ++c) {
        EXPECT_EQ(one.pixel(i).radiance[c], many.pixel(i).radiance[c]);
        EXPECT_EQ(one.pixel(i).squares[c], many.pixel(i).squares[c]);
      }
  }
}

}  // namespace
}  // namespace turbid::testing
