// Photon points, photon beams and paths: `upbp` and its presets against themselves and against `bdpt`.
#include "integrator/upbp.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <limits>
#include <map>
#include <tuple>

#include "integrator/agreement.h"
#include "integrator/suite.h"
#include "integrator/technique_pilot.h"

namespace turbid::testing {
namespace {

using namespace pieces;

Film render_upbp(const std::string& integrator, uint32_t samples, int threads = 2,
                 const std::string& xml = suite_scene("lamp in fog, any length").xml) {
  return render_samples(xml, integrator, samples, threads);
}

// --- the same sums ---------------------------------------------------------------------------------------------------

TEST(Upbp, IsBdptWithoutMerging) {
  for (const char* heuristic : {"power", "balance"}) {
    const std::string rest = std::string(",heuristic=") + heuristic;
    expect_same(render_upbp("upbp,techniques=bpt" + rest, 4), render_upbp("bdpt" + rest, 4));
  }
}

TEST(Upbp, DoesNotDependOnThreads) {
  expect_same(render_upbp("upbp,techniques=bpt+surf+pp3d+pb2d+bp2d+bb1d", 2, 1),
              render_upbp("upbp,techniques=bpt+surf+pp3d+pb2d+bp2d+bb1d", 2, 3));
}

TEST(Upbp, TechniquesAddUpToTheImage) {
  const std::string all = "upbp,techniques=bpt+surf+pp3d+pb2d+bp2d+bb1d,radius=0.2";
  const Film film = render_upbp(all + ",visualize_techniques=true", 8), without = render_upbp(all, 8);
  const std::vector<std::string>& names = film.layer_names();
  ASSERT_EQ(names.size(), 3 * kTechniqueNames.size());
  std::vector<double> sums(names.size());
  for (size_t i = 0; i < film.pixel_count(); ++i) {
    double sum = 0;
    for (size_t k = 0; k < names.size(); k += 3) sum += film.layers(i)[k];
    for (size_t k = 0; k < names.size(); ++k) sums[k] += film.layers(i)[k];
    EXPECT_NEAR(sum, film.pixel(i).radiance[0], 1e-3 * (1 + film.pixel(i).radiance[0]));
    EXPECT_EQ(film.pixel(i).radiance[0], without.pixel(i).radiance[0]);
  }
  for (size_t k = 0; k < names.size(); ++k) EXPECT_GT(sums[k], 0) << names[k] << " contributes nothing";
}

// --- small radii make the picture of bdpt ----------------------------------------------------------------------------

/// Photons correlate pixels, and are rare in single blocks: whole pictures are compared. Where one of the two misses
/// what specular surfaces show, it is the rest of the picture, cut out in smaller blocks.
constexpr int kBlock = 16, kSmallBlock = 4;

/// What `bdpt` makes of the scene; made once.
const Observation& reference_of(const SuiteScene& scene, uint32_t samples, int block) {
  static std::map<std::tuple<std::string, uint32_t, int>, Observation> made;
  const auto key = std::tuple(scene.name, samples, block);
  auto found = made.find(key);
  if (found == made.end()) found = made.emplace(key, observe(scene.xml, {"bdpt", samples, 1, 1}, block)).first;
  return found->second;
}

/// Radii small enough that their bias is under the noise, and wide enough that light finds kernels in every pass.
void expect_bdpt(const SuiteScene& scene, const std::string& contestant, uint32_t samples, size_t comparisons,
                 double largest_error = 1) {
  samples *= scene.effort;
  const auto comparison = [&](int block) {
    return compare(reference_of(scene, samples, block), observe(scene.xml, {contestant, samples, 1, 2}, block));
  };
  Agreement agreement = comparison(kBlock);
  const bool whole = agreement.cannot.empty();
  if (!whole) agreement = comparison(kSmallBlock);
  ASSERT_TRUE(agreement.cannot.empty()) << scene.name << ", " << contestant << ": " << agreement.cannot;
  EXPECT_TRUE(whole ? agreement.accepted(comparisons) : agreement.means_accepted(comparisons))
      << scene.name << ", " << contestant << "\n"
      << agreement.report();
  EXPECT_LT(agreement.ratio_error[0], largest_error) << scene.name << ", " << contestant;
}

const char* const kSmall = ",radius=0.03,surface_radius=0.03,keep=1,beam_paths=1000";

class UpbpTechnique : public ::testing::TestWithParam<const char*> {};

TEST_P(UpbpTechnique, AgreesWithBdpt) {
  // Balls find little: they are larger, and there is more light for them.
  const bool balls = std::string(GetParam()).ends_with("pp3d");
  const char* const rest = balls ? ",radius=0.12,surface_radius=0.03,keep=1,light_paths=16" : kSmall;
  for (const char* name : {"lamp in fog, any length", "chromatic medium", "laser in fog"})
    expect_bdpt(suite_scene(name), fmt::format("upbp,techniques={}{}", GetParam(), rest), 8, 30);
}

INSTANTIATE_TEST_SUITE_P(Sets, UpbpTechnique,
                         ::testing::Values("surf+pp3d", "surf+pb2d", "surf+bp2d", "surf+bb1d", "bpt+bb1d",
                                           "surf+pp3d+pb2d+bp2d+bb1d", "bpt+surf+pp3d+pb2d+bp2d+bb1d"),
                         [](const auto& instance) { return test_name(instance.param); });

/// Kernels in a dense medium are smaller than those around it, by default.
TEST(Upbp, EachMediumHasItsOwnRadius) {
  for (const char* techniques : {"surf+pb2d", "surf+pp3d", "surf+bb1d", "bpt+surf+pp3d+pb2d+bp2d+bb1d"})
    expect_bdpt(suite_scene("several media in turn"),
                fmt::format("upbp,techniques={},surface_radius=0.03,keep=1,light_paths=16,beam_paths=1000", techniques),
                8, 4, 0.1);
}

TEST(Upbp, LongAndShortBeamsAgree) {
  for (const char* kind : {",photon_beams=long", ",sensor_beams=long", ",photon_beams=long,sensor_beams=long"})
    for (const char* techniques : {"surf+pb2d+bb1d", "bpt+surf+pb2d+bp2d+bb1d"})
      expect_bdpt(suite_scene("chromatic medium"), fmt::format("upbp,techniques={}{}{}", techniques, kSmall, kind), 8,
                  10);
}

TEST(Upbp, HarnessNoticesAPlantedError) {
  const std::string& xml = suite_scene("lamp in fog, any length").xml;
  const std::string all = fmt::format("upbp,techniques=bpt+surf+pp3d+pb2d+bp2d+bb1d{}", kSmall);
  const Observation right = observe(xml, {"bdpt", 16}, kBlock);
  EXPECT_FALSE(compare(right, observe(xml, {all, 16, 1.04, 2}, kBlock)).accepted());
  EXPECT_TRUE(compare(right, observe(xml, {all, 16, 1, 2}, kBlock)).accepted());
}

class UpbpEverywhere : public ::testing::TestWithParam<SuiteScene> {};

TEST_P(UpbpEverywhere, AgreesWithBdpt) {
  const std::vector<std::string> ways = {"bpt+surf+pp3d+pb2d+bp2d+bb1d", "surf+pb2d", "surf+bb1d",
                                         "bpt+bb1d,photon_beams=long,sensor_beams=long"};
  const size_t comparisons = (ways.size() + 1) * suite().size();
  for (const std::string& techniques : ways)
    expect_bdpt(GetParam(), fmt::format("upbp,techniques={}{}", techniques, kSmall), 64, comparisons);
  // Balls find little: there is more light for them. In the whole of an endless world it is not enough.
  if (GetParam().name != "endless medium under a sky")
    expect_bdpt(GetParam(), fmt::format("upbp,techniques=surf+pp3d,light_paths=64{}", kSmall), 16, comparisons);
}

INSTANTIATE_TEST_SUITE_P(SlowScenes, UpbpEverywhere, ::testing::ValuesIn(suite()),
                         [](const auto& instance) { return test_name(instance.param.name); });

/// With a bound on memory fewer light paths are traced, and the picture stays what it is.
TEST(Upbp, KeepsToItsMemory) {
  const SuiteScene& scene = suite_scene("lamp in fog, any length");
  const std::string many = "upbp,techniques=surf+pb2d,radius=0.03,surface_radius=0.03,keep=1,light_paths=160";
  constexpr uint32_t kImages = 2;
  const auto bytes_of = [&](const std::string& integrator) {
    LoadedScene loaded = load_scene_from_string(scene.xml, "test scene", {});
    const IntegratorSetup setup = make_named(integrator, loaded);
    render_with(Scene(std::move(loaded.parts)), *setup.integrator, kImages);
    return static_cast<double>(setup.integrator->counters()["photons"]) / kImages * sizeof(PhotonPoint);
  };
  constexpr double kBound = 1 << 20;
  EXPECT_GT(bytes_of(many), 2 * kBound) << "nothing to bound";
  EXPECT_LT(bytes_of(many + ",memory=1"), 1.05 * kBound);
  EXPECT_GT(bytes_of(many + ",memory=1"), 0.5 * kBound) << "more would fit, with what makes photons searchable";
  expect_bdpt(scene, many + ",memory=1", 4, 1);
}

/// A fuller set for half as much again, not for more.
TEST(Upbp, PilotTakesTheFullestSetThatCostsLittleMore) {
  const auto choice = [](std::vector<double> products) { return fullest_affordable(products); };
  EXPECT_EQ(choice({1, 1.2, 1.3, 1.49, 1.51}), 3u);
  EXPECT_EQ(choice({2.7, 1.3, 1, 1.03, 2}), 3u);
  EXPECT_EQ(choice({1, 9, 9, 9, 9}), 0u);
  EXPECT_EQ(choice({4, 6, 1.3, 1.4, 1}), 4u);
  const double nothing = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(choice({nothing, nothing}), 0u);
}

// --- what users say
// ----------------------------------------------------------------------------------------------------

std::string message_of(const std::string& settings) {
  try {
    render_upbp(settings, 1);
  } catch (const SceneError& error) {
    return error.what();
  }
  return {};
}

TEST(Upbp, RefusesWhatMakesNoSense) {
  EXPECT_NE(message_of("upbp,techniques=bpt+pb3d").find("names 'pb3d', expected some of bpt, surf"), std::string::npos)
      << message_of("upbp,techniques=bpt+pb3d");
  EXPECT_NE(message_of("upbp,techniques=").find("must name some of"), std::string::npos);
  EXPECT_NE(message_of("upbp,keep=0").find("(0, 1]"), std::string::npos);
  EXPECT_NE(message_of("upbp,photon_beams=endless").find("short"), std::string::npos);
}

}  // namespace
}  // namespace turbid::testing
