// Multiple scattering by tables: against random walks in a medium without end, and against `volpath` where the medium
// ends far away.
#include "integrator/table_light.h"

#include <gtest/gtest.h>

#include "integrator/agreement.h"
#include "integrator/entering_lights.h"
#include "integrator/many_lights.h"
#include "integrator/path_tracer.h"
#include "integrator/suite.h"
#include "integrator/upbp.h"
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
  TableSettings settings;
  settings.source = source;
  settings.from_order = from_order;
  settings.request.settings.deposits = 200'000;
  settings.request.folder = folder.path().string();
  return settings;
}

std::unique_ptr<Integrator> make_volpath(const PathSettings& path, const TableSettings& table) {
  return std::make_unique<PathTracer>(PathTracer::Kind::kVolumes, path, ConnectionSettings{}, std::nullopt, table,
                                      EnteringLightsSettings{.lights = 50});
}
std::unique_ptr<Integrator> make_vrl(const PathSettings& path, const TableSettings& table) {
  ManyLightsSettings own;
  own.rays = true;
  own.sampler = ManyLightsSettings::Sampler::kAll;
  own.lights = 30;
  own.reuse = 1;
  own.volume_points.count = 2;
  own.table = table;
  own.entering.lights = 400;
  return std::make_unique<ManyLights>(path, own);
}
std::unique_ptr<Integrator> make_upbp(const PathSettings& path, const TableSettings& table) {
  UpbpSettings own;
  own.techniques.set(static_cast<size_t>(Technique::kJoin));
  own.techniques.set(static_cast<size_t>(Technique::kPointPoint));
  own.radius = 0.02f;
  own.table = table;
  own.entering.lights = 1600;  // shared by EnteringLightSets::kReuse samples, one pass
  return std::make_unique<Upbp>(path, own);
}

Observation observe_by(const std::string& xml, std::unique_ptr<Integrator> integrator, uint32_t samples, uint64_t seed,
                       double brightness = 1) {
  LoadedScene loaded = load_scene_from_string(xml, "test scene", {});
  return observe(Scene(std::move(loaded.parts)), *integrator, {"", samples, brightness, seed}, 8);
}

void expect_same_light(const std::string& what, const Observation& first, const Observation& second,
                       double largest_error, bool same = true) {
  const Agreement agreement = compare(first, second);
  ASSERT_TRUE(agreement.cannot.empty()) << agreement.cannot;
  EXPECT_EQ(agreement.accepted(), same) << what << "\n" << agreement.report();
  EXPECT_LT(agreement.ratio_error[0], largest_error) << what << "\n" << agreement.report();
}

// Deep in fog the model is true.
TEST(TableLight, DeepInFogIsWhatPathsFind) {
  const Observation paths = observe_by(deep_fog(), make_volpath({}, {}), 96, 1);
  expect_same_light("model", paths, observe_by(deep_fog(), make_volpath({}, settings_for_tests(Source::kModel)), 32, 2),
                    0.02);
  for (const int from_order : {2, 3, 5})
    expect_same_light("volpath", paths,
                      observe_by(deep_fog(), make_volpath({}, settings_for_tests(Source::kTable, from_order)), 32, 3),
                      0.02);
  expect_same_light("a brightness of 1.1", paths,
                    observe_by(deep_fog(), make_volpath({}, settings_for_tests()), 32, 3, 1.1), 0.03, false);
}

/// A ball that bends light, in the light of a large lamp. With a floor, light enters again.
std::string bright_ball(bool floor) {
  const std::string lamp =
      ball("1, -2, 4", 1.2f, R"(<emitter type="area"><rgb name="radiance" value="3, 4, 5"/></emitter>)");
  const std::string content = lamp + glass("0, 0, 0.8", 1.1f, medium("interior", "3, 4, 3.5", "0.9, 0.95, 0.8", 0.3f));
  return scene(content + (floor ? kFloor : ""), "", kPinhole);
}

// The table as published is coarser, but of the same light.
TEST(TableLight, ModeSeedIsNearTheExactTable) {
  TableSettings exact = settings_for_tests(), seed = exact;
  seed.mode = TableSettings::Mode::kSeed;
  seed.photons.photons = 60'000;
  const PathSettings path{.min_scattering = 3};
  const Observation truth = observe_by(deep_fog(), make_vrl(path, exact), 2, 1);
  const auto ratio = [&](double brightness) {
    const Agreement agreement = compare(truth, observe_by(deep_fog(), make_vrl(path, seed), 2, 2, brightness));
    EXPECT_LT(agreement.ratio_error[0], 0.015) << agreement.report();
    return agreement.mean_ratio[0];
  };
  EXPECT_NEAR(ratio(1), 1, 0.05);
  EXPECT_GT(std::abs(ratio(0.9) - 1), 0.05) << "a brightness of 0.9 is not noticed";
}

void expect_integrators_agree(const TableSettings& table) {
  const PathSettings path{.min_scattering = 3};
  const Observation vrl = observe_by(bright_ball(false), make_vrl(path, table), 6, 1);
  expect_same_light("upbp", vrl, observe_by(bright_ball(false), make_upbp(path, table), 24, 2), 0.01);
  expect_same_light("volpath", vrl, observe_by(bright_ball(false), make_volpath(path, table), 128, 3), 0.03);
  expect_same_light("a brightness of 1.05", vrl, observe_by(bright_ball(false), make_upbp(path, table), 24, 2, 1.05),
                    0.01, false);
}

// What the table stands for, all find alike.
TEST(TableLight, IntegratorsAgreeOnIt) {
  TableSettings table = settings_for_tests();
  expect_integrators_agree(table);
  table.images = true;
  expect_integrators_agree(table);
}

// So they do where it is weighed by what leaves; each has sets of its own for that.
TEST(SlowTableLight, IntegratorsAgreeOnWhatIsMeasured) {
  TableSettings table = settings_for_tests();
  table.measured = true;
  expect_integrators_agree(table);
}

// A thin ball that reflects inside, in even light from all sides: measured, it shines as walks say, where the table
// alone is far off.
TEST(TableLight, MeasuredLeavesAsMuchAsWalksBring) {
  const std::string lit = scene(R"(<emitter type="constant"><rgb name="radiance" value="1, 2, 1.5"/></emitter>)" +
                                    glass("0, 0, 0.8", 1.1f, medium("interior", "2, 3, 2.5", "0.95, 0.98, 0.9", 0.7f)),
                                "", kPinhole);
  const PathSettings path{.min_scattering = 3};
  TableSettings table = settings_for_tests();
  const auto by = [&](const TableSettings& settings, uint32_t samples, double brightness = 1) {
    return observe_by(lit,
                      std::make_unique<PathTracer>(PathTracer::Kind::kVolumes, path, ConnectionSettings{}, std::nullopt,
                                                   settings, EnteringLightsSettings{.lights = 20'000}),
                      samples, 1, brightness);
  };
  const Observation truth = by({}, 128);
  const auto ratio = [&](const Observation& other) {
    const Agreement agreement = compare(truth, other);
    EXPECT_LT(agreement.ratio_error[0], 0.02) << agreement.report();
    return agreement.mean_ratio[0];
  };
  EXPECT_GT(std::abs(ratio(by(table, 32)) - 1), 0.15);
  table.measured = true;
  EXPECT_NEAR(ratio(by(table, 32)), 1, 0.05);
  EXPECT_GT(std::abs(ratio(by(table, 32, 0.88)) - 1), 0.05) << "a brightness of 0.88 is not noticed";
}

// What the table does not have, it does not touch: in whatever way a method makes paths, their visits are counted.
TEST(TableLight, LeavesLowerOrdersAlone) {
  const PathSettings path{.max_scattering = 2};
  const Observation plain = observe_by(bright_ball(true), make_volpath(path, {}), 128, 1);
  const TableSettings table = settings_for_tests();
  expect_same_light("volpath", plain, observe_by(bright_ball(true), make_volpath(path, table), 128, 2), 0.03);
  expect_same_light("vrl", plain, observe_by(bright_ball(true), make_vrl(path, table), 16, 3), 0.03);
  expect_same_light("upbp", plain, observe_by(bright_ball(true), make_upbp(path, table), 16, 4), 0.03);
}

// Two collisions, one of them on a way of light that has entered: where nothing reflects inside, all of them are found.
TEST(TableLight, TwoCollisionsAreThoseOfPaths) {
  const std::string lamp =
      ball("1, -2, 4", 1.2f, R"(<emitter type="area"><rgb name="radiance" value="3, 4, 5"/></emitter>)");
  const std::string lit = scene(
      lamp + kFloor +
          ball("0, 0, 0.8", 1.1f, R"(<bsdf type="null"/>)" + medium("interior", "3, 4, 3.5", "0.9, 0.95, 0.8", 0.3f)),
      "", kPinhole);
  TableSettings table = settings_for_tests(Source::kTable, 2);
  table.images = true;
  const PathSettings path{.max_scattering = 2};
  const Observation plain = observe_by(lit, make_volpath(path, {}), 96, 1);
  // The table's own orders are left out by a limit that none of its shortest paths keeps.
  const auto by_table = [&](auto make, uint32_t samples, double brightness = 1) {
    return observe_by(lit, make(path, table), samples, 2, brightness);
  };
  expect_same_light("volpath", plain, by_table(make_volpath, 96), 0.02);
  expect_same_light("upbp", plain, by_table(make_upbp, 24), 0.03);
  expect_same_light("a brightness of 1.1", plain, by_table(make_volpath, 96, 1.1), 0.02, false);
}

// `vrl` stops at boundaries that scatter light, and would not come to what it leaves to tables behind them.
TEST(TableLight, LeavesMediaBehindRoughBoundariesToMethodsThatStopThere) {
  const std::string body = medium("interior", "3, 4, 3.5", "0.9, 0.95, 0.8", 0.3f);
  const auto media = [&](const std::string& bsdf, bool behind_rough) {
    LoadedScene loaded = load_scene_from_string(scene(ball("0, 0, 1", 1, bsdf + body), "", kPinhole), "test scene", {});
    TableSettings settings = settings_for_tests();
    settings.behind_rough = behind_rough;
    return TableLight(Scene(std::move(loaded.parts)), settings).media().size();
  };
  EXPECT_EQ(media(R"(<bsdf type="roughdielectric"/>)", true), 1u);
  EXPECT_EQ(media(R"(<bsdf type="roughdielectric"/>)", false), 0u);
  EXPECT_EQ(media(R"(<bsdf type="dielectric"/>)", false), 1u);
}

// In a box, a walk straight up sees the bottom behind it, and of what is before and beside it what is near enough.
TEST(TableLight, SeesBoundariesOnAllSides) {
  const std::string box = R"(<shape type="cube"><transform name="to_world"><scale x="2" y="2" z="1"/></transform>
      <bsdf type="null"/>)" +
                          medium("interior", "10, 10, 10", "0.9, 0.9, 0.9", 0) + "</shape>";
  LoadedScene loaded = load_scene_from_string(scene(box, "", kPinhole), "test scene", {});
  const Scene built(std::move(loaded.parts));
  const Medium& inside = *built.media().front().medium;
  const Boundaries boundaries(built, {&inside});
  const auto around = [&](const Vec3& x) { return boundaries.around(x, {0, 0, 1}, inside); };
  const BoundaryPlanes middle = around({0, 0, -0.9f});
  ASSERT_EQ(middle.size(), 1u);  // all else is more than 12 mean free paths away
  EXPECT_NEAR(middle[0].normal.z, -1, 1e-6f);
  EXPECT_NEAR(middle[0].point.z, -1, 1e-5f);
  EXPECT_NEAR(middle[0].extrapolation, 2.0f / 30, 1e-5f);
  EXPECT_EQ(around({0, 0, 0}).size(), 2u);
  const BoundaryPlanes corner = around({1.9f, 1.8f, 0.5f});
  ASSERT_EQ(corner.size(), 4u);
  Vec3 sum(0);
  for (const BoundaryPlane& plane : corner) {
    EXPECT_NEAR(plane.share, 1, 1e-5f);
    sum += plane.normal;
  }
  EXPECT_LT(length(sum - Vec3(1, 1, 0)), 1e-5f);
  EXPECT_TRUE(boundaries.lets_see({0, 0, -0.9f}, {1, 1, 0.9f}));
  EXPECT_FALSE(boundaries.lets_see({0, 0, -0.9f}, {0, 0, 1.5f}));
}

/// Lights that have entered the ball, in a set for a film of that size; `lights` as the parameter says.
size_t paths_for_film(int width, int height, size_t lights, bool count = false) {
  std::string xml = bright_ball(false);
  const auto replace = [&](const std::string& from, const std::string& to) {
    xml.replace(xml.find(from), from.size(), to);
  };
  replace(integer("width", 16), integer("width", width));
  replace(integer("height", 16), integer("height", height));
  LoadedScene loaded = load_scene_from_string(xml, "test scene", {});
  const Scene built(std::move(loaded.parts));
  const PathSettings path;
  const TableLight table(built, settings_for_tests());
  const EnteringLightsPlan plan{built, path, table, 1};
  const size_t paths = paths_for_entering_lights(plan, lights);
  if (!count) return paths;
  SampleCounters counters;
  return EnteringLights(plan, paths, 0, counters).size();
}

// Four for each pixel, but 8000 at least and 400,000 at most: in numbers of light paths, which are made in proportion.
TEST(EnteringLights, AreAsManyAsTheFilmAsksFor) {
  const auto near = [](size_t found, double expected) {
    EXPECT_NEAR(static_cast<double>(found) / expected, 1, 1e-3) << found << " instead of " << expected;
  };
  const auto one = static_cast<double>(paths_for_film(16, 16, 100'000)) / 100'000;
  near(paths_for_film(16, 16, 0), 8000 * one);
  near(paths_for_film(40, 50, 0), 8000 * one);
  near(paths_for_film(100, 80, 0), 32'000 * one);
  near(paths_for_film(250, 399, 0), 399'000 * one);
  near(paths_for_film(1000, 1000, 0), 400'000 * one);
  near(paths_for_film(1000, 1000, 500), 500 * one);  // said, it does not go by the film
  near(paths_for_film(16, 16, 3'000'000), 3'000'000 * one);
  // And so many do enter.
  EXPECT_NEAR(static_cast<double>(paths_for_film(100, 80, 0, true)) / 32'000, 1, 0.05);
}

/// A layer of 200 mean free paths' width in even light, seen from above where its edges are far.
struct Layer {
  std::string name;
  float g, albedo, index;  ///< index 1: nothing bends light
  float thickness;         ///< mean free paths

  friend void PrintTo(const Layer& layer, std::ostream* out) { *out << layer.name; }
};

std::string scene_of(const Layer& layer) {
  const std::string boundary = layer.index == 1
                                   ? R"(<bsdf type="null"/>)"
                                   : R"(<bsdf type="dielectric"><float name="int_ior" value=")" +
                                         std::to_string(layer.index) + R"("/><float name="ext_ior" value="1"/></bsdf>)";
  const std::string half = std::to_string(layer.thickness / 200), albedo = std::to_string(layer.albedo);
  return R"(<scene version="3.0.0"><integrator type="volpath"/>
  <sensor type="orthographic"><transform name="to_world"><scale x="0.5" y="0.5" z="1"/>
  <lookat origin="0, 0, 3" target="0, 0, 0" up="0, 1, 0"/></transform>)" +
         kFilm + R"(</sensor><emitter type="constant"><rgb name="radiance" value="1"/></emitter>
  <shape type="cube"><transform name="to_world"><scale x="1" y="1" z=")" +
         half + R"("/><translate z="-)" + half + R"("/></transform>)" + boundary +
         medium("interior", "100, 100, 100", albedo + ", " + albedo + ", " + albedo, layer.g) +
         R"(</shape><shape type="rectangle"><transform name="to_world"><scale value="10"/><translate z="-1.1"/></transform>
  <bsdf type="diffuse"><rgb name="reflectance" value="0"/></bsdf></shape></scene>)";
}

ImageMean reflected(const Layer& layer, const TableSettings& table, uint32_t samples) {
  LoadedScene loaded = load_scene_from_string(scene_of(layer), "test scene", {});
  const PathSettings path{.rr_depth = 20, .min_scattering = 3};
  PathTracer tracer(PathTracer::Kind::kVolumes, path, {}, {}, table, {.lights = 10'000, .samples = 8});
  return mean_of(render_with(Scene(std::move(loaded.parts)), tracer, samples));
}

class SlowTableLightOfLayers : public ::testing::TestWithParam<Layer> {};

// Orders from 3 on, with boundaries corrected, against the truth; and what the endless medium makes of them.
TEST_P(SlowTableLightOfLayers, WithinATenth) {
  const Layer& layer = GetParam();
  TableSettings table = settings_for_tests();
  const double truth = reflected(layer, {}, 96).grey();
  const double plain = reflected(layer, table, 256).grey() / truth;
  table.images = true;
  const double corrected = reflected(layer, table, 256).grey() / truth;
  table.images = false;
  table.measured = true;
  const double measured = reflected(layer, table, 256).grey() / truth;
  std::printf("%-28s g %.1f, albedo %.3f, index %.3f: endless %.3f, image %.3f, measured %.3f\n", layer.name.c_str(),
              layer.g, layer.albedo, layer.index, plain, corrected, measured);
  EXPECT_NEAR(corrected, 1, 0.1) << layer.name;
  EXPECT_NEAR(measured, 1, 0.08) << layer.name;
}
INSTANTIATE_TEST_SUITE_P(
    SlowLayers, SlowTableLightOfLayers,
    ::testing::Values(Layer{"isotropic", 0, 0.9f, 1, 100}, Layer{"isotropic, bright", 0, 0.99f, 1, 100},
                      Layer{"isotropic, glossy", 0, 0.9f, 1.5f, 100}, Layer{"wax", 0.8f, 0.98f, 1.446f, 100},
                      Layer{"bumpy sphere", 0.9f, 0.95f, 1.3f, 100}, Layer{"skin", 0.8f, 0.95f, 1.5f, 100},
                      Layer{"milk", 0.7f, 0.999f, 1.33f, 100}, Layer{"mist, 5 mean free paths", 0.4f, 0.94f, 1, 5}),
    [](const auto& instance) { return test_name(instance.param.name); });

TEST(TableLight, RefusesLimitsThatASumCannotKeep) {
  const auto message = [](const std::string& settings) {
    try {
      render_text(scene(kLamp, settings), 1);
    } catch (const std::exception& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  const std::string table = R"(<string name="multiple_scattering" value="table"/>)";
  EXPECT_NE(message(table + integer("max_scattering", 7)).find("the table holds all orders from 3 on at once"),
            std::string::npos);
  EXPECT_NE(message(table + integer("min_scattering", 4)).find("use a limit up to that"), std::string::npos);
  EXPECT_NE(message(table + R"(<string name="nee" value="once_more"/>)").find("nee = standard"), std::string::npos);
  EXPECT_EQ(message(table + integer("min_scattering", 3)), "");
}

}  // namespace
}  // namespace turbid::testing
