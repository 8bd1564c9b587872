// `bdpt` against `volpath` and `ptracer` on the scenes of the suite, quickly; at length in agreement_test.cpp.
#include "integrator/bdpt.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "integrator/agreement.h"
#include "integrator/suite.h"

namespace turbid::testing {
namespace {

using namespace pieces;

class BdptOnTheSuite : public ::testing::TestWithParam<SuiteScene> {};

TEST_P(BdptOnTheSuite, AgreesWithAnotherIntegrator) {
  const SuiteScene& scene = GetParam();
  const Observation bdpt = observe(scene.xml, {"bdpt", 16 * scene.effort, 1, 2}, scene.block);
  Agreement agreement;
  for (const char* other : {"volpath", "ptracer"}) {
    if (!scene.has_variance(other)) continue;
    agreement = compare(observe(scene.xml, {other, 64 * scene.effort}, scene.block), bdpt);
    if (agreement.cannot.empty()) break;
  }
  EXPECT_EQ(agreement.cannot, "");
  EXPECT_TRUE(agreement.accepted(suite().size())) << agreement.report();
}

std::string name_of(const ::testing::TestParamInfo<SuiteScene>& instance) {
  std::string name = instance.param.name;
  for (char& c : name) c = std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
  return name;
}

INSTANTIATE_TEST_SUITE_P(Scenes, BdptOnTheSuite, ::testing::ValuesIn(suite()), name_of);

TEST(Bdpt, HarnessNoticesAPlantedError) {
  const std::string xml = scene(kLamp + kFloor + fog(), integer("max_depth", 5));
  const Observation right = observe(xml, {"volpath", 64}), wrong = observe(xml, {"bdpt", 16, 1.04, 2});
  EXPECT_FALSE(compare(right, wrong).accepted());
}

TEST(Bdpt, BalanceHeuristicAndFewConnections) {
  const std::string xml = scene(kLamp + kFloor + fog(), integer("rr_depth", 2));
  const Observation reference = observe(xml, {"volpath", 64});
  for (const char* settings : {"bdpt,heuristic=balance", "bdpt,connections=1", "bdpt,connections=3.5"}) {
    const Agreement agreement = compare(reference, observe(xml, {settings, 16, 1, 2}));
    EXPECT_TRUE(agreement.accepted()) << settings << "\n" << agreement.report();
  }
}

TEST(Bdpt, FilterAndCropOfTheFilm) {
  expect_agreement(scene(kLamp + kFloor + fog(), integer("max_depth", 5), kCropped), {"volpath", 64},
                   {"bdpt", 16, 1, 2});
}

TEST(Bdpt, HidesEmitters) {
  expect_agreement(scene(kLamp + kFloor, integer("max_depth", 5) + R"(<boolean name="hide_emitters" value="true"/>)"),
                   {"volpath", 64}, {"bdpt", 16, 1, 2});
}

Film render_bdpt(const std::string& xml, const std::string& settings, uint32_t samples) {
  LoadedScene loaded = load_scene_from_string(xml, "test scene", {});
  std::vector<std::pair<std::string, std::string>> values;
  if (!settings.empty()) values.emplace_back(settings, "true");
  const auto replaced = replace_integrator(loaded.integrator, "bdpt", values);
  const IntegratorSetup setup = make_integrator(replaced.description, loaded.document.get());
  return render_with(Scene(std::move(loaded.parts)), *setup.integrator, samples);
}

// Weighted layers add up to the picture; each plain layer that stands alone is an estimate of the same light.
TEST(Bdpt, StrategiesAddUpToTheImage) {
  const std::string xml = scene(kLamp + kFloor + fog(), integer("max_depth", 4));
  const Film film = render_bdpt(xml, "visualize_strategies", 64);
  const Film without = render_bdpt(xml, "", 64);
  const std::vector<std::string>& names = film.layer_names();
  ASSERT_FALSE(names.empty());
  for (size_t i = 0; i < film.pixel_count(); ++i) {
    double sum = 0;
    for (size_t k = 0; k < names.size(); ++k)
      if (names[k].starts_with("strategy.weighted.") && names[k].ends_with(".R")) sum += film.layers(i)[k];
    EXPECT_NEAR(sum, film.pixel(i).radiance[0], 1e-3 * (1 + film.pixel(i).radiance[0]));
    EXPECT_EQ(film.pixel(i).radiance[0], without.pixel(i).radiance[0]);
  }
  // Paths of two edges: by chance, by next-event estimation, by joining the light's walk with the sensor.
  std::vector<double> means;
  for (int s = 0; s <= 2; ++s) {
    const auto name = std::find(names.begin(), names.end(), "strategy.plain.2." + std::to_string(s) + ".R");
    ASSERT_NE(name, names.end());
    double sum = 0;
    for (size_t i = 0; i < film.pixel_count(); ++i) sum += film.layers(i)[static_cast<size_t>(name - names.begin())];
    means.push_back(sum / static_cast<double>(film.pixel_count() * film.samples()));
  }
  EXPECT_NEAR(means[0] / means[1], 1, 0.15);  // the lamp is met rarely
  EXPECT_NEAR(means[2] / means[1], 1, 0.03);
}

TEST(Bdpt, GivesTheSameBitsForAnyNumberOfThreads) {
  const auto render = [&](size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return render_bdpt(scene(kLamp + kFloor + fog(), integer("max_depth", 5)), "visualize_strategies", 8);
  };
  const Film one = render(1);
  for (const size_t threads : {size_t{2}, size_t{7}}) {
    const Film many = render(threads);
    for (size_t i = 0; i < one.pixel_count(); ++i) {
      for (size_t c = 0; c < kChannels; ++c) EXPECT_EQ(one.pixel(i).radiance[c], many.pixel(i).radiance[c]);
      EXPECT_TRUE(std::ranges::equal(one.layers(i), many.layers(i)));
    }
  }
}

}  // namespace
}  // namespace turbid::testing
