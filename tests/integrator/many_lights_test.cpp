// Virtual lights: `vpl` and `vrl` against `volpath`, and their ways of choosing lights against all lights.
#include "integrator/many_lights.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <map>

#include "integrator/agreement.h"
#include "integrator/suite.h"
#include "integrator/without_near_light.h"

namespace turbid::testing {
namespace {

using namespace pieces;

// Without the light over shorter lines: it has no variance (NUMERICS 6).
constexpr float kLeastDistance = 0.3f;

/// What pieces::integer() wrote.
int integer_in(const std::string& xml, const std::string& name, int otherwise) {
  const std::string before = "<integer name=\"" + name + "\" value=\"";
  const size_t at = xml.find(before);
  return at == std::string::npos ? otherwise : std::stoi(xml.substr(at + before.size()));
}

/// Light of order 0 may be a small lamp or a caustic met by chance, with more noise than all other light.
double least_error(const Agreement& agreement) { return std::min(agreement.ratio_error[0], agreement.ratio_error[2]); }

Observation observe_reference(const std::string& xml, uint32_t samples, int block) {
  LoadedScene loaded = load_scene_from_string(xml, "test scene", {});
  PathSettings settings;
  settings.max_depth = integer_in(xml, "max_depth", settings.max_depth);
  settings.rr_depth = integer_in(xml, "rr_depth", settings.rr_depth);
  WithoutNearLight reference(settings, kLeastDistance);
  return observe(Scene(std::move(loaded.parts)), reference, {"volpath", samples, 1, 1}, block);
}

/// What `volpath` makes of the scene, in several times the samples of those that are compared with it; made once.
const Observation& reference_of(const SuiteScene& scene, uint32_t samples, int block) {
  constexpr uint32_t kMoreSamples = 16;
  static std::map<std::pair<std::string, uint32_t>, Observation> made;
  const auto key = std::pair(scene.name, samples);
  auto found = made.find(key);
  if (found == made.end())
    found = made.emplace(key, observe_reference(scene.xml, kMoreSamples * samples * scene.effort, block)).first;
  return found->second;
}

/// `how`, vpl or vrl, makes the picture of `volpath`, in whole and by order. Its lights are new in each of the samples.
void expect_volpath(const SuiteScene& scene, const std::string& how, uint32_t samples, size_t comparisons,
                    double largest_error, double brightness = 1) {
  const int block = std::max(8, scene.block);
  const std::string integrator = fmt::format("{},least_distance={},reuse=1", how, kLeastDistance);
  const Observation seen = observe(scene.xml, {integrator, samples * scene.effort, brightness, 2}, block);
  const Agreement agreement = compare(reference_of(scene, samples, block), seen);
  ASSERT_TRUE(agreement.cannot.empty()) << scene.name << agreement.cannot;
  if (brightness != 1) {
    EXPECT_FALSE(agreement.accepted(comparisons)) << "a planted error goes unnoticed\n" << agreement.report();
    return;
  }
  EXPECT_TRUE(agreement.accepted(comparisons)) << scene.name << ", " << how << "\n" << agreement.report();
  EXPECT_LT(least_error(agreement), largest_error) << scene.name << "\n" << agreement.report();
}

TEST(VplAgreement, WithVolpath) {
  const std::string all = "vpl,light_sampler=all,lights=40,volume_points=2";
  for (const char* name : {"lamp in fog, any length", "chromatic medium", "coarse mesh, rough metal"})
    expect_volpath(suite_scene(name), all, 4, 4, 0.05);
}

TEST(VrlAgreement, WithVolpath) {
  const std::string all = "vrl,light_sampler=all,lights=40,volume_points=2";
  for (const char* name : {"lamp in fog, any length", "chromatic medium", "heterogeneous medium"})
    expect_volpath(suite_scene(name), all, 4, 3, 0.05);
}

TEST(VplAgreement, NoticesAnError) {
  expect_volpath(suite_scene("lamp in fog, any length"), "vpl,light_sampler=all,lights=40,volume_points=2", 4, 4, 1,
                 1.15);
}

class ManyLightsAgreementEverywhere : public ::testing::TestWithParam<SuiteScene> {};

TEST_P(ManyLightsAgreementEverywhere, WithVolpath) {
  const SuiteScene& scene = GetParam();
  LoadedScene loaded = load_scene_from_string(scene.xml, "test scene", {});
  const Scene assembled(std::move(loaded.parts));
  if (!scene.has_variance("volpath")) GTEST_SKIP() << "volpath has no variance here";
  for (const Emitter* emitter : assembled.emitters())
    if (!emitter->can_be_aimed_at()) GTEST_SKIP() << "beams are not sampled";
  const std::vector<std::string> ways = {
      "vpl,light_sampler=all,lights=100,volume_points=4", "vrl,light_sampler=all,lights=100,volume_points=4",
      "vpl,light_sampler=light_tree,lights=400,light_samples=8,volume_sampling=uniform"};
  for (const std::string& how : ways) expect_volpath(scene, how, 8, ways.size() * suite().size(), 0.03);
}

INSTANTIATE_TEST_SUITE_P(SlowScenes, ManyLightsAgreementEverywhere, ::testing::ValuesIn(suite()),
                         [](const auto& instance) { return test_name(instance.param.name); });

// --- ways of choosing lights ---------------------------------------------------------------------------------------

/// With the same lights every way makes the picture that all lights make.
void expect_all_lights(const std::string& scene, const std::string& how, uint32_t samples, double largest_error,
                       double brightness = 1) {
  // One set for the whole render, so that it is the choice alone that is compared. Noise: that of the choice and of the
  // places on ways through media.
  const std::string same = fmt::format("lights=200,reuse=1000000,volume_points=2,least_distance={}", kLeastDistance);
  const std::string method = how.substr(0, 4);
  const std::string& xml = suite_scene(scene).xml;
  // Each method's picture is made once.
  static std::map<std::string, Observation> pictures;
  const std::string reference = method + same + ",light_sampler=all";
  auto all = pictures.find(scene + reference);
  if (all == pictures.end())
    all = pictures.emplace(scene + reference, observe(xml, {reference, std::max(2u, samples / 4), 1, 1}, 8)).first;
  const Observation chosen = observe(xml, {how + "," + same, samples, brightness, 1}, 8);
  const Agreement agreement = compare(all->second, chosen);
  if (brightness != 1) {
    EXPECT_FALSE(agreement.accepted()) << agreement.report();
    return;
  }
  EXPECT_TRUE(agreement.accepted(8)) << scene << ", " << how << "\n" << agreement.report();
  EXPECT_LT(least_error(agreement), largest_error) << scene << ", " << how << "\n" << agreement.report();
}

const std::string kCache = "light_sampler=importance_cache,surface_caches=100,volume_caches=200";
const std::vector<std::string> kWays = {
    "vpl,light_sampler=uniform", "vpl,light_sampler=power", "vpl,light_sampler=lfg", "vpl,light_sampler=light_tree",
    "vrl,light_sampler=uniform", "vpl," + kCache,           "vrl," + kCache};

TEST(ManyLightsSamplers, MakeThePictureOfAllLights) {
  for (const std::string& way : kWays) expect_all_lights("lamp in fog, any length", way, 4, 0.025);
  expect_all_lights("heterogeneous medium", "vpl," + kCache, 4, 0.05);
}

TEST(ManyLightsSamplers, NoticeAnError) { expect_all_lights("lamp in fog, any length", kWays.back(), 8, 1, 1.05); }

class ManyLightsSamplersEverywhere : public ::testing::TestWithParam<const char*> {};

TEST_P(ManyLightsSamplersEverywhere, MakeThePictureOfAllLights) {
  for (const std::string& way : kWays) expect_all_lights(GetParam(), way, 128, 0.03);
}

INSTANTIATE_TEST_SUITE_P(SlowScenes, ManyLightsSamplersEverywhere,
                         ::testing::Values("lamp in fog, any length", "coarse mesh, rough metal",
                                           "several media in turn", "rough glass with murk", "caustic into fog",
                                           "priorities and a world medium"),
                         [](const auto& instance) { return test_name(instance.param); });

// --- the pass structure ---------------------------------------------------------------------------------------------

Film render_vpl(const std::string& settings, uint32_t first, uint32_t samples, int threads = 2) {
  const std::string small = "vpl,lights=50,surface_caches=20,volume_caches=20,reuse=2";
  return render_samples(suite_scene("lamp in fog, any length").xml, small + (settings.empty() ? "" : "," + settings),
                        samples, threads, first);
}

TEST(ManyLightsPasses, DoNotDependOnThreads) {
  for (const char* sampler : {"all", "importance_cache", "light_tree"}) {
    const std::string settings = std::string("light_sampler=") + sampler;
    expect_same(render_vpl(settings, 0, 4, 1), render_vpl(settings, 0, 4, 3));
  }
}

TEST(ManyLightsPasses, GoOnWhereTheyStopped) {
  Film parts = render_vpl("", 0, 3);
  parts.add(render_vpl("", 3, 3));
  const Film whole = render_vpl("", 0, 6);
  for (size_t i = 0; i < whole.pixel_count(); ++i)
    for (int c = 0; c < kChannels; ++c)
      EXPECT_NEAR(parts.pixel(i).radiance[c], whole.pixel(i).radiance[c], 1e-12 * whole.pixel(i).radiance[c]);
}

TEST(ManyLightsPasses, RefuseWhatMakesNoSense) {
  const auto message = [](const std::string& settings) {
    try {
      render_vpl(settings, 0, 1);
    } catch (const SceneError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_NE(message("light_sampler=some").find("importance_cache"), std::string::npos) << message("light_sampler=some");
  EXPECT_NE(message("reuse=0").find("at least 1"), std::string::npos) << message("reuse=0");
  EXPECT_NE(message("nearest=9").find("in [1, 8]"), std::string::npos) << message("nearest=9");
}

}  // namespace
}  // namespace turbid::testing
