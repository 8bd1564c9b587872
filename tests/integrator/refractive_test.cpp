// Single scattering through smooth meshes, as `singlescatter` finds it, against `volpath`, which meets the same lamps
// by chance: the whole picture and each order. What is left out of the paths and what is put in its place must be the
// same.
#include <gtest/gtest.h>

#include <fstream>

#include "integrator/refractive_scenes.h"
#include "testing/temporary_folder.h"

namespace turbid::testing {
namespace {

using namespace pieces;

struct Comparison {
  std::string name, xml;
  uint32_t samples;               ///< of refractive scattering, per pass
  uint32_t volpath_samples = 64;  ///< where a lamp of radius 0.8 is to be met often enough
  double largest_error = 0.09;    ///< of the ratio in the quick test; what it must resolve to say anything

  friend void PrintTo(const Comparison& comparison, std::ostream* out) { *out << comparison.name; }
};

std::vector<Comparison> comparisons(float lamp_radius) {
  const std::string far = lamp("0.8, 0.9, 3", lamp_radius), near = lamp("0.2, 0.1, 1.1", lamp_radius / 3);
  const std::string depth = integer("max_depth", 7);
  const std::string around = fog_around(), murky = kGlass + clear(), fog_outside = R"(<ref name="exterior" id="fog"/>)";
  return {
      {"sphere", scene(far + kFloor + sphere(murky), depth), 4},
      {"bumpy_sphere", scene(far + kFloor + bumpy(murky), depth), 4},
      {"slab", scene(far + kFloor + slab(murky), depth), 16},
      {"coarse_glass", scene(far + kFloor + octahedron("<scale value=\"0.9\"/><translate z=\"1\"/>", murky), depth), 8,
       128},
      {"camera_in_bumpy_sphere", scene(far + kFloor + bumpy(murky), depth, camera_inside()), 4},
      {"lamp_in_glass_in_fog", scene(around + near + kFloor + bumpy(kGlass + fog_outside), depth), 1, 64},
      {"lamp_in_murky_glass_in_fog", scene(around + near + kFloor + bumpy(murky + fog_outside), depth), 1, 64, 0.15},
      {"camera_and_lamp_in_glass", scene(around + near + kFloor + bumpy(murky + fog_outside), depth, camera_inside()),
       2, 128},
      {"sky", scene(kSky + kFloor + bumpy(murky), depth), 8}};
}

/// What one integrator adds to what singlescatter shows without refractive scattering. Both follow the same paths, so
/// everything else cancels.
PassStatistics added_light(const std::string& xml, const std::string& integrator,
                           const std::vector<std::pair<std::string, std::string>>& settings, uint32_t samples,
                           uint64_t seed, int block, double brightness = 1) {
  Rendering whole(xml, integrator, settings),
      rest(xml, "singlescatter", {{"method", "none"}, {"environments", "true"}});
  PassStatistics result({16, 16}, block);
  for (uint32_t pass = 0; pass < kPasses; ++pass) {
    Film film = whole.pass(seed, pass, samples);
    const Film without = rest.pass(seed, pass, samples);
    for (size_t i = 0; i < film.pixel_count(); ++i)
      for (size_t c = 0; c < kChannels; ++c)
        film.pixel(i).radiance[c] = (film.pixel(i).radiance[c] - without.pixel(i).radiance[c]) * brightness;
    result.add(film);
  }
  EXPECT_EQ(whole.counters()["dropped_samples"], 0u);
  return result;
}

void expect_agreement(const Comparison& scene, uint32_t volpath_samples, double effort, double largest_error) {
  const PassStatistics by_chance = added_light(scene.xml, "volpath", {}, volpath_samples, 1, 8);
  const auto samples = static_cast<uint32_t>(effort * scene.samples);
  const PassStatistics followed = added_light(scene.xml, "singlescatter", {{"environments", "true"}}, samples, 2, 8);
  const Verdict verdict = compare_light(by_chance, followed);
  std::printf("%-28s ratio %.4f +- %.4f, worst |z| %.2f of %zu blocks\n", scene.name.c_str(), verdict.ratio,
              verdict.error, verdict.blocks.worst_z, by_chance.block_count());
  EXPECT_TRUE(verdict.accepted(static_cast<double>(comparisons(1).size())));
  EXPECT_LT(verdict.error, largest_error) << "too noisy to say anything";
  // The harness sees an error of a few times what it resolves.
  const Verdict planted = compare_light(by_chance, added_light(scene.xml, "singlescatter", {{"environments", "true"}},
                                                               samples, 2, 8, 1 + 6 * largest_error));
  EXPECT_FALSE(planted.accepted(static_cast<double>(comparisons(1).size())));
}

class RefractiveScatteringAgrees : public ::testing::TestWithParam<Comparison> {};
TEST_P(RefractiveScatteringAgrees, WithVolpath) {
  expect_agreement(GetParam(), GetParam().volpath_samples, 1, GetParam().largest_error);
}
INSTANTIATE_TEST_SUITE_P(Scenes, RefractiveScatteringAgrees, ::testing::ValuesIn(comparisons(0.8f)),
                         [](const auto& instance) { return instance.param.name; });

/// Means of the light of each order, over the whole picture.
std::array<ImageMean, kOrderClasses> by_order(const std::string& xml, const std::string& integrator,
                                              const std::vector<std::pair<std::string, std::string>>& settings) {
  LoadedScene loaded = load_scene_from_string(xml, "test scene", {});
  const IntegratorSetup setup =
      make_integrator(replace_integrator(loaded.integrator, integrator, settings).description, loaded.document.get());
  const Scene scene(std::move(loaded.parts));
  std::vector<std::string> names;
  std::vector<OrderLayer> layers;
  for (int order = 0; order < kOrderClasses; ++order) {
    layers.push_back({order, order, names.size()});
    for (const char* channel : {".R", ".G", ".B"}) names.push_back("order" + std::to_string(order) + channel);
  }
  EXPECT_TRUE(setup.integrator->split_orders(layers));
  const StopFlag stop;
  setup.integrator->prepare(scene, 1, stop);
  Film film({16, 16}, names);
  setup.integrator->render_pass(scene, {1, 0, 32}, film, stop);
  std::array<ImageMean, kOrderClasses> result;
  for (const OrderLayer& layer : layers)
    for (size_t i = 0; i < film.pixel_count(); ++i)
      for (size_t c = 0; c < kChannels; ++c)
        result[static_cast<size_t>(layer.min_order)].mean[c] += film.layers(i)[layer.channel + c];
  return result;
}

TEST(RefractiveScattering, ChangesNothingButOrderOne) {
  const std::string xml = comparisons(0.8f)[1].xml;
  const auto plain = by_order(xml, "volpath", {}), followed = by_order(xml, "singlescatter", {}),
             switched = by_order(xml, "volpath", {{"single_scattering", "refractive"}});
  for (const size_t order : {0, 2, 3}) {
    EXPECT_GT(plain[order].grey(), 0);
    for (int c = 0; c < kChannels; ++c) EXPECT_EQ(plain[order].mean[c], followed[order].mean[c]) << order;
  }
  EXPECT_NE(plain[1].grey(), followed[1].grey());
  for (size_t order = 0; order < kOrderClasses; ++order) EXPECT_EQ(followed[order].grey(), switched[order].grey());
}

TEST(RefractiveScattering, KeepsToTheOrdersAndDepthsThatAreAskedFor) {
  const auto light = [](const std::string& settings) {
    const std::string above = R"(<emitter type="point"><point name="position" value="0.8, 0.9, 3"/></emitter>)";
    const std::string xml = scene(above + bumpy(kGlass + clear()), settings);
    return by_order(xml, "singlescatter", {})[1].grey();
  };
  EXPECT_GT(light(""), 0);
  EXPECT_EQ(light(integer("max_scattering", 0)), 0);
  EXPECT_EQ(light(integer("min_scattering", 2)), 0);
  // Into the glass, to V, to P, to the light: four edges.
  EXPECT_GT(light(integer("max_depth", 4)), 0);
  EXPECT_EQ(light(integer("max_depth", 3)), 0);
}

/// What singlescatter says while it prepares for a mesh in a file, and that it renders it.
std::string words_about(const std::string& type, const std::string& file) {
  const std::string shape = "<shape type=\"" + type + "\"><string name=\"filename\" value=\"" + file +
                            "\"/><transform name=\"to_world\"><translate z=\"1\"/></transform>" + kGlass + clear() +
                            "</shape>";
  ::testing::internal::CaptureStderr();
  Rendering rendering(scene(kPoint + kFloor + shape, integer("max_depth", 6)), "singlescatter", {});
  const Film film = rendering.pass(1, 0, 8);
  std::string words = ::testing::internal::GetCapturedStderr();
  EXPECT_GT(mean_of(film).grey(), 0);
  EXPECT_EQ(rendering.counters()["dropped_samples"], 0u);
  return words;
}

TEST(RefractiveScattering, WarnsOfHolesAndTurnedTriangles) {
  const TemporaryFolder folder;
  const std::string vertices = "v 1 0 0\nv -1 0 0\nv 0 1 0\nv 0 -1 0\nv 0 0 1\nv 0 0 -1\n";
  const std::string seven = "f 1 3 5\nf 3 2 5\nf 2 4 5\nf 4 1 5\nf 3 1 6\nf 2 3 6\nf 4 2 6\n";
  const auto write = [&](const std::string& name, const std::string& text) {
    std::ofstream(folder.file(name)) << text;
    return folder.file(name);
  };
  const std::string warning = "has holes or turned triangles";
  const auto warned = [&](const std::string& words) { return words.find(warning) != std::string::npos; };
  EXPECT_FALSE(warned(words_about("obj", write("whole.obj", vertices + seven + "f 1 4 6\n"))));
  EXPECT_TRUE(warned(words_about("obj", write("hole.obj", vertices + seven))));
  EXPECT_TRUE(warned(words_about("obj", write("turned.obj", vertices + seven + "f 4 1 6\n"))));
  EXPECT_TRUE(warned(
      words_about("ply", write("hole.ply",
                               "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\n"
                               "property float z\nelement face 7\nproperty list uchar int vertex_indices\nend_header\n"
                               "1 0 0\n-1 0 0\n0 1 0\n0 -1 0\n0 0 1\n0 0 -1\n3 0 2 4\n3 2 1 4\n3 1 3 4\n3 3 0 4\n"
                               "3 2 0 5\n3 1 2 5\n3 3 5 1\n"))));
}

/// At length, with a smaller lamp.
class SlowRefractiveScatteringAgrees : public ::testing::TestWithParam<Comparison> {};
TEST_P(SlowRefractiveScatteringAgrees, WithVolpath) {
  expect_agreement(GetParam(), 64 * GetParam().volpath_samples, 6, GetParam().largest_error / 3);
}
INSTANTIATE_TEST_SUITE_P(Slow, SlowRefractiveScatteringAgrees, ::testing::ValuesIn(comparisons(0.4f)),
                         [](const auto& instance) { return instance.param.name; });

}  // namespace
}  // namespace turbid::testing
