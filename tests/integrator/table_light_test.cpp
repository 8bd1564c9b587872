// Multiple scattering by tables: against random walks in a medium without end, and against `volpath` where the medium
// ends far away.
#include "integrator/table_light.h"

#include <gtest/gtest.h>

#include "integrator/agreement.h"
#include "integrator/path_tracer.h"
#include "integrator/suite.h"
#include "testing/temporary_folder.h"

namespace turbid::testing {
namespace {

using namespace pieces;
using Source = TableSettings::Source;

/// A lamp that stops no light, and the sensor, deep in fog whose end is 20 mean free paths and more away.
std::string deep_fog(const std::string& settings = "") {
  const std::string lamp =
      ball("0.5, 0.3, 1", 0.5f,
           R"(<bsdf type="null"/><emitter type="area"><rgb name="radiance" value="3, 4, 5"/></emitter>)");
  return scene(
      lamp + ball("0, 0, 0", 24, R"(<bsdf type="null"/>)" + medium("interior", "1, 1.2, 0.9", "0.8, 0.7, 0.85", 0.3f)),
      settings);
}

/// A small table that all tests of this program share.
TableSettings settings_for_tests(Source source = Source::kTable, int from_order = 3) {
  static const TemporaryFolder folder;
  TableSettings settings{source, from_order, {}};
  settings.request.settings.deposits = 200'000;
  settings.request.folder = folder.path().string();
  return settings;
}

Observation observe_volpath(const std::string& xml, const TableSettings& table, const Contestant& how, int block = 8) {
  LoadedScene loaded = load_scene_from_string(xml, "test scene", {});
  PathTracer tracer(PathTracer::Kind::kVolumes, PathSettings{}, {}, {}, table);
  return observe(Scene(std::move(loaded.parts)), tracer, how, block);
}

void expect_same_light(const Observation& first, const Observation& second, double largest_error, bool same = true) {
  const Agreement agreement = compare(first, second);
  ASSERT_TRUE(agreement.cannot.empty()) << agreement.cannot;
  EXPECT_EQ(agreement.accepted(), same) << agreement.report();
  EXPECT_LT(agreement.ratio_error[0], largest_error) << agreement.report();
  std::printf("%s\n", agreement.report().c_str());
}

TEST(TableLight, DeepInFogIsWhatPathsFind) {
  const Observation paths = observe_volpath(deep_fog(), {}, {"volpath", 128, 1, 1});
  const Observation model = observe_volpath(deep_fog(), settings_for_tests(Source::kModel), {"model", 64, 1, 2});
  const Observation table = observe_volpath(deep_fog(), settings_for_tests(), {"table", 64, 1, 3});
  expect_same_light(paths, model, 0.02);
  expect_same_light(paths, table, 0.02);
  expect_same_light(paths, observe_volpath(deep_fog(), settings_for_tests(), {"table", 64, 1.1, 3}), 0.02, false);
}

}  // namespace
}  // namespace turbid::testing
