// Gathering volumes: `mcrt` against itself, against closed forms, and against `bdpt`.
#include "integrator/mcrt.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include "integrator/agreement.h"
#include "integrator/suite.h"

namespace turbid::testing {
namespace {

using namespace pieces;

const SuiteScene& suite_scene(const std::string& name) {
  static const std::vector<SuiteScene> scenes = suite();
  return *std::find_if(scenes.begin(), scenes.end(), [&](const SuiteScene& scene) { return scene.name == name; });
}

// --- at a fixed radius all q have the same expectation --------------------------------------------------------------

const char* const kFixed = ",radius=0.2,keep=1";

struct QCase {
  const char *scene, *estimator;
  uint32_t samples;
};
class FixedRadius : public ::testing::TestWithParam<QCase> {};

TEST_P(FixedRadius, AllQHaveOneExpectation) {
  const std::string& xml = suite_scene(GetParam().scene).xml;
  const std::string rest = std::string(kFixed) + ",estimator=" + GetParam().estimator;
  const uint32_t samples = GetParam().samples;
  const Observation one = observe(xml, {"mcrt,q=1" + rest, 4 * samples, 1, 1}, 8);
  for (const char* q : {"0.3", "0.1"}) {
    const Agreement agreement = compare(one, observe(xml, {std::string("mcrt,q=") + q + rest, samples, 1, 2}, 8));
    EXPECT_EQ(agreement.cannot, "");
    EXPECT_TRUE(agreement.accepted(8)) << q << "\n" << agreement.report();
    EXPECT_LT(agreement.ratio_error[0], 0.02) << "too noisy to say anything";
  }
  const Agreement planted = compare(one, observe(xml, {"mcrt,q=0.3" + rest, samples, 1.1, 2}, 8));
  EXPECT_FALSE(planted.accepted(8)) << "an error of a tenth must show";
}

INSTANTIATE_TEST_SUITE_P(Estimators, FixedRadius,
                         ::testing::Values(QCase{"lamp in fog, any length", "track", 32},
                                           QCase{"lamp in fog, any length", "collision", 64},
                                           QCase{"chromatic medium", "track", 32},
                                           QCase{"heterogeneous medium", "track", 32}),
                         [](const auto& instance) {
                           std::string name = std::string(instance.param.scene) + instance.param.estimator;
                           std::erase_if(name, [](char c) { return !std::isalnum(static_cast<unsigned char>(c)); });
                           return name;
                         });

/// A box of fog: its lights are those of the suite.
std::string fog_box(const std::string& medium) {
  return scene(kLamp + kFloor + R"(<shape type="cube"><transform name="to_world"><translate x="0.1" y="0.1" z="1.1"/>
               </transform><bsdf type="null"/>)" +
                   medium + "</shape>",
               integer("max_depth", 5));
}

/// A heterogeneous medium that is the same everywhere gathers as a homogeneous one does by collisions.
TEST(McrtHeterogeneous, ContainsTheHomogeneousOne) {
  const std::string varied = R"(<medium name="interior" type="heterogeneous"><volume name="sigma_t" type="constvolume">
    <rgb name="value" value="0.3, 0.6, 0.9"/><transform name="to_world"><scale value="4"/>
    <translate x="-2" y="-2" z="-1"/></transform></volume><volume name="albedo" type="constvolume">
    <rgb name="value" value="0.9, 0.8, 0.7"/></volume></medium>)";
  const std::string same = R"(<medium name="interior" type="homogeneous"><rgb name="sigma_t" value="0.3, 0.6, 0.9"/>
    <rgb name="albedo" value="0.9, 0.8, 0.7"/></medium>)";
  const std::string how = std::string("mcrt,q=0.25,estimator=collision") + kFixed;
  const Agreement agreement =
      compare(observe(fog_box(same), {how, 32, 1, 1}, 8), observe(fog_box(varied), {how, 32, 1, 2}, 8));
  EXPECT_TRUE(agreement.accepted()) << agreement.report();
  EXPECT_LT(agreement.ratio_error[2], 0.05) << agreement.report();
}

/// Long and short cylinders and segments are one expectation, too.
TEST(McrtCylinders, LongAndShortAgree) {
  const std::string& xml = suite_scene("chromatic medium").xml;
  const std::string cylinder = std::string("mcrt,volumes=cylinder") + kFixed;
  const Observation shortest = observe(xml, {cylinder + ",cylinders=short", 12, 1, 1}, 8);
  for (const char* kind : {"", ",segments=long", ",cylinders=short,segments=long", ",estimator=collision"}) {
    const Agreement agreement = compare(shortest, observe(xml, {cylinder + kind, 12, 1, 2}, 8));
    EXPECT_TRUE(agreement.accepted(4)) << kind << "\n" << agreement.report();
    EXPECT_LT(agreement.ratio_error[0], 0.02) << kind;
  }
}

// --- the bias of smooth light falls with the square of the radius ---------------------------------------------------

constexpr double kSigmaT = 0.25, kSigmaS = 0.2, kG = 0.3;

/// A point light at height 1 over the line of sight, in fog without end; single scattering, one thin pencil of rays.
std::string endless_fog(int pixels) {
  return R"(<scene version="3.0.0"><integrator type="volpath"><integer name="max_scattering" value="1"/></integrator>
  <sensor type="perspective"><float name="fov" value="0.2"/><transform name="to_world">
  <lookat origin="0, -3, 0" target="0, 0, 0" up="0, 0, 1"/></transform><film type="hdrfilm">)" +
         integer("width", pixels) + integer("height", pixels) + R"(<rfilter type="box"/></film></sensor>
  <emitter type="point"><point name="position" value="0, 0, 1"/><rgb name="intensity" value="1"/></emitter>)" +
         ball("0, 0, 0", 40,
              R"(<bsdf type="null"/>)" +
                  medium("interior", "0.25, 0.25, 0.25", "0.8, 0.8, 0.8", static_cast<float>(kG))) +
         "</scene>";
}

/// Radiance along the middle ray by quadrature.
double single_scattering() {
  double sum = 0;
  constexpr double kStep = 1e-3;
  for (double t = kStep / 2; t < 40; t += kStep) {
    const double y = t - 3, r = std::sqrt(y * y + 1);
    const double mu = -y / r;  // from the light to the point, then towards the sensor
    const double f = (1 - kG * kG) / (4 * std::numbers::pi * std::pow(1 + kG * kG - 2 * kG * mu, 1.5));
    sum += kSigmaS * f * std::exp(-kSigmaT * (t + r)) / (r * r) * kStep;
  }
  return sum;
}

/// How much is spent on a bias: images, their pixels across, and the light paths for each pixel. Light alone makes the
/// noise of cylinders; spheres need many walks from the sensor, too.
struct Effort {
  uint32_t samples;
  int pixels, light_paths;
};
struct Bias {
  double relative, error;
};
Bias bias_of(const std::string& volumes, double radius, const Effort& effort) {
  const std::string contestant =
      fmt::format("mcrt,{},radius={},keep=1,segments=long,light_paths={}", volumes, radius, effort.light_paths);
  const Observation seen = observe(endless_fog(effort.pixels), {contestant, effort.samples, 1, 7}, 16);
  const double truth = single_scattering();
  return {seen.all.mean(0, 0) / truth - 1, std::sqrt(seen.all.variance(0, 0) / kPasses) / truth};
}

void expect_slope_two(const std::string& volumes, const std::vector<double>& radii, const Effort& effort) {
  std::vector<Bias> biases;
  for (const double radius : radii) {
    biases.push_back(bias_of(volumes, radius, effort));
    std::printf("%-40s radius %.2f: bias %8.5f +- %.5f\n", volumes.c_str(), radius, biases.back().relative,
                biases.back().error);
  }
  for (size_t i = 0; i + 1 < radii.size(); ++i) {
    const Bias &large = biases[i], &small = biases[i + 1];
    const double ratio = std::log(radii[i] / radii[i + 1]);
    const double slope = std::log(large.relative / small.relative) / ratio;
    const double error = std::hypot(large.error / large.relative, small.error / small.relative) / ratio;
    std::printf("%-40s slope %.3f +- %.3f\n", volumes.c_str(), slope, error);
    // What is left of higher orders in the largest radius.
    constexpr double kHigherOrders = 0.15;
    EXPECT_LT(std::abs(slope - 2), kHigherOrders + 3 * error) << volumes;
    EXPECT_LT(error, 0.15) << "too noisy to say anything";
  }
}

constexpr Effort kQuickCylinder{4, 1, 20000};

TEST(McrtBias, FallsWithTheSquareOfTheRadius) { expect_slope_two("volumes=cylinder", {0.6, 0.3}, kQuickCylinder); }
TEST(McrtBias, VanishesAtSmallRadii) {
  const Bias bias = bias_of("volumes=cylinder", 0.03, kQuickCylinder);
  EXPECT_LT(std::abs(bias.relative), 4 * bias.error);
  EXPECT_LT(bias.error, 0.02);
}
TEST(SlowMcrtBias, FallsWithTheSquareOfTheRadius) {
  expect_slope_two("volumes=cylinder", {0.6, 0.3, 0.15}, {16, 1, 80000});
  for (const char* volumes : {"q=1", "q=0.1", "q=0.3,estimator=collision"})
    expect_slope_two(volumes, {0.6, 0.3}, {512, 8, 16});
}

/// The difference of cylinder and spheres is one of biases.
TEST(SlowMcrtBias, CylindersAndSpheresMeet) {
  const Effort effort{512, 8, 16};
  const Bias cylinder = bias_of("volumes=cylinder", 0.05, effort), spheres = bias_of("q=0.1", 0.05, effort);
  EXPECT_LT(std::abs(cylinder.relative - spheres.relative), 4 * std::hypot(cylinder.error, spheres.error));
}

// --- small radii make the picture of bdpt ---------------------------------------------------------------------------

void expect_bdpt(const SuiteScene& scene, const std::string& contestant, uint32_t samples, size_t comparisons) {
  const int block = std::max(scene.block, 8);
  const Observation reference = observe(scene.xml, {"bdpt", samples * scene.effort, 1, 1}, block);
  const Agreement agreement = compare(reference, observe(scene.xml, {contestant, samples * scene.effort, 1, 2}, block));
  if (!agreement.cannot.empty()) return;
  EXPECT_TRUE(agreement.accepted(comparisons)) << scene.name << ", " << contestant << "\n" << agreement.report();
}

TEST(McrtAgreement, WithBdpt) {
  for (const char* name : {"lamp in fog, any length", "laser in fog", "caustic into fog"})
    for (const char* how : {"volumes=cylinder", "q=0.05,surface_light=volumes"})
      expect_bdpt(suite_scene(name), std::string("mcrt,radius=0.02,keep=1,") + how, 32, 6);
}

TEST(SlowMcrtAgreement, WithBdptEverywhere) {
  const std::vector<std::string> ways = {"volumes=cylinder", "q=0.05", "q=0.05,collisions=-1", "q=0.05,surfaces=paths",
                                         "volumes=cylinder,surface_light=volumes"};
  for (const SuiteScene& scene : suite())
    for (const std::string& how : ways)
      expect_bdpt(scene, "mcrt,radius=0.01,keep=1," + how, 128, ways.size() * suite().size());
}

// --- the pass structure
// -----------------------------------------------------------------------------------------------

Film render_mcrt(const std::string& settings, uint32_t samples, int threads = 2,
                 const std::string& xml = suite_scene("lamp in fog, any length").xml) {
  LoadedScene loaded = load_scene_from_string(xml, "test scene", {});
  std::vector<std::pair<std::string, std::string>> values = {{"radius", "0.1"}};
  for (size_t at = 0; at < settings.size();) {
    const size_t end = std::min(settings.find(',', at), settings.size()), equals = settings.find('=', at);
    values.emplace_back(settings.substr(at, equals - at), settings.substr(equals + 1, end - equals - 1));
    at = end + 1;
  }
  const auto replaced = replace_integrator(loaded.integrator, "mcrt", values);
  const IntegratorSetup setup = make_integrator(replaced.description, loaded.document.get());
  const Scene scene(std::move(loaded.parts));
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, static_cast<size_t>(threads));
  tbb::task_arena arena(threads);
  return arena.execute([&] { return render_with(scene, *setup.integrator, samples); });
}

void expect_same(const Film& a, const Film& b) {
  for (size_t i = 0; i < a.pixel_count(); ++i)
    for (int c = 0; c < kChannels; ++c) EXPECT_EQ(a.pixel(i).radiance[c], b.pixel(i).radiance[c]) << i;
}

TEST(McrtPasses, DoNotDependOnThreads) {
  for (const char* settings : {"q=auto", "volumes=cylinder"})
    expect_same(render_mcrt(settings, 4, 1), render_mcrt(settings, 4, 3));
}

TEST(McrtPasses, DoNotDependOnMemory) {
  std::string xml = suite_scene("lamp in fog, any length").xml;
  for (size_t at; (at = xml.find("value=\"16\"/>")) != std::string::npos;) xml.replace(at, 10, "value=\"140\"");
  expect_same(render_mcrt("q=0.1,memory=1", 1, 2, xml), render_mcrt("q=0.1,memory=1024", 1, 2, xml));
}

TEST(McrtPasses, RefuseWhatMakesNoSense) {
  const auto message = [](const std::string& settings) {
    try {
      render_mcrt(settings, 1);
    } catch (const SceneError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_NE(message("q=some").find("must be a number or 'auto'"), std::string::npos) << message("q=some");
  EXPECT_NE(message("q=0").find("expected a number in (0, 1]"), std::string::npos) << message("q=0");
  EXPECT_NE(message("collisions=0").find("must be at least 1, or -1"), std::string::npos) << message("collisions=0");
  EXPECT_NE(message("volumes=ball").find("sphere"), std::string::npos) << message("volumes=ball");
}

}  // namespace
}  // namespace turbid::testing
