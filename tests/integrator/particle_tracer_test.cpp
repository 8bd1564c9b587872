// `ptracer` against `volpath`: the same light followed from its other end. Two-estimator z-tests over passes, in blocks
// of 4 x 4 pixels (NUMERICS 10).
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <fstream>

#include "image/z_test.h"
#include "integrator/rendering.h"
#include "testing/temporary_folder.h"

namespace turbid::testing {
namespace {

constexpr uint32_t kPasses = 32;

struct Effort {
  uint32_t volpath = 16, ptracer = 32;  ///< samples per pass
};

PassStatistics statistics_of(const std::string& xml, const std::string& integrator, uint32_t samples,
                             double brightness = 1) {
  LoadedScene loaded = load_scene_from_string(xml, "test scene", {});
  const auto replaced = replace_integrator(loaded.integrator, integrator, {});
  const IntegratorSetup setup = make_integrator(replaced.description, loaded.document.get());
  const Scene scene(std::move(loaded.parts));
  StopFlag stop;
  setup.integrator->prepare(scene, 1, stop);
  const Vec2i size = scene.film().crop_size.x > 0 ? scene.film().crop_size : scene.film().size;
  PassStatistics statistics(size, 4);
  for (uint32_t pass = 0; pass < kPasses; ++pass) {
    Film film(size);
    setup.integrator->render_pass(scene, {1, uint64_t{pass} * samples, samples}, film, stop);
    for (PixelSums& pixel : film.pixels())
      for (double& value : pixel.radiance) value *= brightness;
    statistics.add(film);
  }
  EXPECT_EQ(setup.integrator->counters()["dropped_samples"], 0u);
  EXPECT_EQ(setup.integrator->counters()["saturated_splats"], 0u);
  return statistics;
}

ZTestResult compare(const std::string& xml, const Effort& effort, double brightness = 1) {
  const PassStatistics volpath = statistics_of(xml, "volpath", effort.volpath);
  const PassStatistics ptracer = statistics_of(xml, "ptracer", effort.ptracer, brightness);
  double mean = 0, error = 0;
  for (size_t b = 0; b < volpath.block_count(); ++b) {
    mean += volpath.mean(b, 0) / static_cast<double>(volpath.block_count());
    error += std::sqrt((volpath.variance(b, 0) + ptracer.variance(b, 0)) / kPasses) /
             static_cast<double>(volpath.block_count());
  }
  EXPECT_GT(mean, 0) << "nothing to compare";
  EXPECT_LT(error, 0.05 * mean) << "too noisy to say anything";
  return two_estimator_z_test(volpath, ptracer);
}

void expect_same(const std::string& xml, const Effort& effort = {}) {
  const ZTestResult result = compare(xml, effort);
  EXPECT_TRUE(result.accepted()) << 100 * result.pass_fraction() << " % pass, worst |z| " << result.worst_z
                                 << " in block " << result.worst_index << ", p " << result.smallest_p;
}

const std::string kFilm = R"(<film type="hdrfilm"><integer name="width" value="16"/><integer name="height" value="16"/>
  <rfilter type="box"/></film>)";
const std::string kPinhole = R"(<sensor type="perspective"><float name="fov" value="45"/>
  <transform name="to_world"><lookat origin="0, -6, 2" target="0, 0, 0.5" up="0, 0, 1"/></transform>)" +
                             kFilm + "</sensor>";
const std::string kFloor = R"(<shape type="rectangle"><transform name="to_world"><scale value="3"/></transform>
  <bsdf type="diffuse"><rgb name="reflectance" value="0.7, 0.5, 0.3"/></bsdf></shape>)";
const std::string kLamp = R"(<shape type="sphere"><point name="center" value="0.5, 0.3, 2"/>
  <float name="radius" value="0.4"/><emitter type="area"><rgb name="radiance" value="3, 4, 5"/></emitter></shape>)";
const std::string kPoint = R"(<emitter type="point"><point name="position" value="0.5, 0.3, 1.5"/>
  <rgb name="intensity" value="5, 4, 3"/></emitter>)";

std::string medium(const std::string& role, const std::string& sigma_t, const std::string& albedo, float g = 0.4f) {
  return "<medium name=\"" + role + "\" type=\"homogeneous\"><rgb name=\"sigma_t\" value=\"" + sigma_t +
         "\"/><rgb name=\"albedo\" value=\"" + albedo + "\"/><phase type=\"hg\"><float name=\"g\" value=\"" +
         std::to_string(g) + "\"/></phase></medium>";
}
std::string ball(const std::string& center, float radius, const std::string& content) {
  return "<shape type=\"sphere\"><point name=\"center\" value=\"" + center + "\"/><float name=\"radius\" value=\"" +
         std::to_string(radius) + "\"/>" + content + "</shape>";
}
std::string fog(float radius = 2.5f, const std::string& sigma_t = "0.4, 0.4, 0.4") {
  return ball("0, 0, 0.5", radius, R"(<bsdf type="null"/>)" + medium("interior", sigma_t, "0.9, 0.8, 0.7"));
}

std::string scene(const std::string& content, const std::string& settings = "", const std::string& sensor = kPinhole) {
  return "<scene version=\"3.0.0\"><integrator type=\"volpath\">" + settings + "</integrator>" + sensor + content +
         "</scene>";
}
std::string integer(const std::string& name, int value) {
  return "<integer name=\"" + name + "\" value=\"" + std::to_string(value) + "\"/>";
}
const std::string kShort = integer("max_depth", 5);

TEST(ParticleTracer, LampOverDiffuseFloor) { expect_same(scene(kLamp + kFloor, kShort)); }

TEST(ParticleTracer, HarnessNoticesAPlantedError) {
  EXPECT_FALSE(compare(scene(kLamp + kFloor, kShort), {}, 1.03).accepted());
}

TEST(ParticleTracer, LongPathsWithRussianRoulette) {
  expect_same(scene(kLamp + kFloor + fog(), integer("rr_depth", 2)), {64, 128});
}

TEST(ParticleTracer, PointLightInFog) { expect_same(scene(kPoint + kFloor + fog(), kShort)); }

TEST(ParticleTracer, SingleOrdersInFog) {
  for (int order = 0; order <= 3; ++order) {
    const std::string most = order < 3 ? integer("max_scattering", order) : "";
    expect_same(scene(kLamp + kFloor + fog(), kShort + integer("min_scattering", order) + most), {64, 128});
  }
}

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

TEST(ParticleTracer, SpotLight) {
  const std::string spot = R"(<emitter type="spot"><rgb name="intensity" value="9, 8, 7"/>
    <float name="cutoff_angle" value="30"/><transform name="to_world">
    <lookat origin="1, 0, 3" target="0, 0, 0" up="0, 1, 0"/></transform></emitter>)";
  expect_same(scene(spot + kFloor + fog(1.5f), kShort));
}

TEST(ParticleTracer, SkyAndSun) {
  const std::string sky = R"(<emitter type="constant"><rgb name="radiance" value="0.5, 0.7, 1"/></emitter>)";
  const std::string sun = R"(<emitter type="directional"><vector name="direction" value="0.3, 0.5, -1"/>
    <rgb name="irradiance" value="2, 1.8, 1.5"/></emitter>)";
  expect_same(scene(sky + kFloor + fog(1.5f), kShort));
  expect_same(scene(sun + kFloor + fog(1.5f), kShort));
}

TEST(ParticleTracer, ThinLens) {
  const std::string lens = R"(<sensor type="thinlens"><float name="fov" value="45"/>
    <float name="aperture_radius" value="0.4"/><float name="focus_distance" value="4"/>
    <transform name="to_world"><lookat origin="0, -6, 2" target="0, 0, 0.5" up="0, 0, 1"/></transform>)" +
                           kFilm + "</sensor>";
  expect_same(scene(kLamp + kFloor, kShort, lens));
  expect_same(scene(kLamp + fog(), kShort, lens));
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
  // The near plane clips collisions, not attenuation: without it their 1/distance^2 has no variance.
  const std::string clipped = R"(<sensor type="perspective"><float name="fov" value="45"/>
    <float name="near_clip" value="2"/>
    <transform name="to_world"><lookat origin="0, -6, 2" target="0, 0, 0.5" up="0, 0, 1"/></transform>)" +
                              kFilm + "</sensor>";
  expect_same(scene(kLamp + kFloor + around, kShort, clipped));
}

TEST(ParticleTracer, MediumWithoutEnd) {
  const std::string clipped = R"(<sensor type="perspective"><float name="fov" value="45"/>
    <float name="near_clip" value="2"/>)" +
                              medium("medium", "0.03, 0.05, 0.08", "0.9, 0.9, 0.9") + R"(
    <transform name="to_world"><lookat origin="0, -6, 2" target="0, 0, 0.5" up="0, 0, 1"/></transform>)" +
                              kFilm + "</sensor>";
  const std::string sky = R"(<emitter type="constant"><rgb name="radiance" value="0.5, 0.7, 1"/></emitter>)";
  expect_same(scene(kLamp + kFloor, integer("max_depth", 4), clipped));
  expect_same(scene(sky + kFloor, integer("max_depth", 3), clipped), {16, 128});
}

TEST(ParticleTracer, PrioritiesAndWorldMedium) {
  const std::string world = medium("world", "0.05, 0.05, 0.05", "0.9, 0.9, 0.9");
  const std::string clipped = R"(<sensor type="perspective"><float name="fov" value="45"/>
    <float name="near_clip" value="2"/>
    <transform name="to_world"><lookat origin="0, -6, 2" target="0, 0, 0.5" up="0, 0, 1"/></transform>)" +
                              kFilm + "</sensor>";
  expect_same(scene(kLamp + kFloor + fog(1.5f) + world, integer("max_depth", 4), clipped));
}

/// A coarse ball with smooth normals: shading and geometric normals are far apart.
std::string octahedron(const TemporaryFolder& folder, const std::string& placement, const std::string& bsdf) {
  const std::string file = folder.file("octahedron.ply");
  std::ofstream(file) << "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\n"
                         "property float z\nproperty float nx\nproperty float ny\nproperty float nz\n"
                         "element face 8\nproperty list uchar int vertex_indices\nend_header\n"
                         "1 0 0 1 0 0\n-1 0 0 -1 0 0\n0 1 0 0 1 0\n0 -1 0 0 -1 0\n0 0 1 0 0 1\n0 0 -1 0 0 -1\n"
                         "3 0 2 4\n3 2 1 4\n3 1 3 4\n3 3 0 4\n3 2 0 5\n3 1 2 5\n3 3 1 5\n3 0 3 5\n";
  return "<shape type=\"ply\"><string name=\"filename\" value=\"" + file + "\"/><transform name=\"to_world\">" +
         placement + "</transform>" + bsdf + "</shape>";
}

TEST(ParticleTracer, MeshWithStronglyVaryingNormals) {
  const TemporaryFolder folder;
  const auto solid = [&](const std::string& bsdf) {
    return octahedron(folder, R"(<rotate z="1" angle="20"/><translate x="-0.4" y="-1" z="1"/>)", bsdf);
  };
  expect_same(scene(kLamp + kFloor + solid(R"(<bsdf type="diffuse"/>)"), kShort), {32, 64});
  expect_same(
      scene(kLamp + kFloor + solid(R"(<bsdf type="roughconductor"><float name="alpha" value="0.4"/></bsdf>)"), kShort),
      {32, 64});
}

// Specular refraction by shading normals on the way from the lamp to the floor; the sensor sees the floor alone.
TEST(ParticleTracer, GlassWithStronglyVaryingNormals) {
  const TemporaryFolder folder;
  const std::string down = R"(<sensor type="perspective"><float name="fov" value="40"/>
    <transform name="to_world"><lookat origin="0.3, -1.2, 0.5" target="0.3, 0.2, 0" up="0, 0, 1"/></transform>)" +
                           kFilm + "</sensor>";
  const std::string glass =
      octahedron(folder, R"(<scale value="0.5"/><rotate z="1" angle="20"/><translate x="0.3" y="0.2" z="1.05"/>)",
                 R"(<bsdf type="dielectric"><float name="int_ior" value="1.4"/></bsdf>)");
  expect_same(scene(kLamp + kFloor + glass, integer("max_depth", 6), down), {512, 128});
}

TEST(ParticleTracer, FilterAndCropOfTheFilm) {
  const std::string cropped = R"(<sensor type="perspective"><float name="fov" value="45"/>
    <transform name="to_world"><lookat origin="0, -6, 2" target="0, 0, 0.5" up="0, 0, 1"/></transform>
    <film type="hdrfilm"><integer name="width" value="32"/><integer name="height" value="24"/>
    <integer name="crop_offset_x" value="10"/><integer name="crop_offset_y" value="4"/>
    <integer name="crop_width" value="16"/><integer name="crop_height" value="16"/>
    <rfilter type="gaussian"/></film></sensor>)";
  expect_same(scene(kLamp + kFloor, kShort, cropped));
}

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
