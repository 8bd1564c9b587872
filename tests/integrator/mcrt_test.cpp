// Gathering volumes: `mcrt` against itself, against closed forms, and against `bdpt`.
#include "integrator/mcrt.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "integrator/agreement.h"
#include "integrator/endless_fog.h"
#include "integrator/suite.h"

namespace turbid::testing {
namespace {

using namespace pieces;

// --- at a fixed radius all q have the same expectation --------------------------------------------------------------

const char* const kFixed = ",radius=0.2,disk_scale=1,keep=1";

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

INSTANTIATE_TEST_SUITE_P(
    Estimators, FixedRadius,
    ::testing::Values(QCase{"lamp in fog, any length", "track", 32}, QCase{"lamp in fog, any length", "collision", 64},
                      QCase{"chromatic medium", "track", 32}, QCase{"heterogeneous medium", "track", 32}),
    [](const auto& instance) { return test_name(std::string(instance.param.scene) + "_" + instance.param.estimator); });

/// Collisions in balls and flights through disks: both count the light at the centre, up to the square of the radius.
TEST(McrtEstimators, CollisionsAndTracksAgree) {
  const std::string& xml = suite_scene("lamp in fog, any length").xml;
  const std::string how = "mcrt,q=0.05,radius=0.1,disk_scale=1,keep=1,estimator=";
  const Observation track = observe(xml, {how + "track", 16, 1, 1}, 8);
  const Agreement agreement = compare(track, observe(xml, {how + "collision", 24, 1, 2}, 8));
  EXPECT_TRUE(agreement.accepted()) << agreement.report();
  EXPECT_FALSE(compare(track, observe(xml, {how + "collision", 24, 1.1, 3}, 8)).accepted()) << "a tenth must show";
}

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
void expect_long_and_short_agree(uint32_t samples, double largest_error) {
  const std::string& xml = suite_scene("chromatic medium").xml;
  const std::string cylinder = std::string("mcrt,volumes=cylinder") + kFixed;
  const Observation shortest = observe(xml, {cylinder + ",cylinders=short", samples, 1, 1}, 8);
  for (const char* kind : {"", ",segments=long", ",cylinders=short,segments=long", ",estimator=collision"}) {
    const Agreement agreement = compare(shortest, observe(xml, {cylinder + kind, samples, 1, 2}, 8));
    EXPECT_TRUE(agreement.accepted(4)) << kind << "\n" << agreement.report();
    EXPECT_LT(agreement.ratio_error[0], largest_error) << kind;
  }
}
TEST(McrtCylinders, LongAndShortAgree) { expect_long_and_short_agree(8, 0.05); }
TEST(SlowMcrtCylinders, LongAndShortAgree) { expect_long_and_short_agree(128, 0.01); }

// --- the bias of smooth light falls with the square of the radius ---------------------------------------------------

using namespace fog;
const std::string kMcrt = "mcrt,segments=long,";

/// The bias is what the kernel does to the light, and that falls with the square of the radius.
TEST(McrtBias, IsThatOfTheKernel) {
  EXPECT_NEAR(slope_of(cylinder_expectation, 0.1), 2, 0.02);
  EXPECT_NEAR(slope_of(sphere_expectation, 0.1), 2, 0.02);
  const Effort light{4, 1, 20000}, both{128, 4, 16};
  expect_expectation(kMcrt + "volumes=cylinder", 0.8, light, cylinder_expectation);
  expect_expectation(kMcrt + "volumes=cylinder", 0.05, light, cylinder_expectation);
  expect_expectation(kMcrt + "q=1", 0.8, both, sphere_expectation);
  expect_expectation(kMcrt + "q=0.1", 0.8, both, sphere_expectation);
}

TEST(SlowMcrtBias, IsThatOfTheKernel) {
  for (const double radius : {0.8, 0.4, 0.2})
    expect_expectation(kMcrt + "volumes=cylinder", radius, {16, 1, 80000}, cylinder_expectation);
  for (const double radius : {0.8, 0.4})
    for (const char* q : {"q=1", "q=0.1"}) expect_expectation(kMcrt + q, radius, {512, 8, 16}, sphere_expectation);
}

// --- small radii make the picture of bdpt ---------------------------------------------------------------------------

/// Radii small enough that their bias is under the noise, and wide enough that light finds volumes in every pass: a
/// block that it finds rarely would seem to have less variance than it has.
void expect_bdpt(const SuiteScene& scene, const std::string& contestant, uint32_t samples, size_t comparisons) {
  const int block = 16;
  const Observation reference = observe(scene.xml, {"bdpt", samples * scene.effort, 1, 1}, block);
  const Agreement agreement = compare(reference, observe(scene.xml, {contestant, samples * scene.effort, 1, 2}, block));
  if (!agreement.cannot.empty()) return;
  EXPECT_TRUE(agreement.accepted(comparisons)) << scene.name << ", " << contestant << "\n" << agreement.report();
}

TEST(McrtAgreement, WithBdpt) {
  for (const char* name : {"lamp in fog, any length", "laser in fog", "caustic into fog"})
    for (const char* how : {"volumes=cylinder", "q=0.05,surface_light=volumes"})
      expect_bdpt(suite_scene(name), std::string("mcrt,radius=0.05,disk_scale=1,keep=1,") + how, 12, 6);
}

class McrtAgreementEverywhere : public ::testing::TestWithParam<SuiteScene> {};

TEST_P(McrtAgreementEverywhere, WithBdpt) {
  const std::vector<std::string> ways = {"volumes=cylinder", "q=0.05", "q=0.05,collisions=-1", "q=0.05,surfaces=paths",
                                         "volumes=cylinder,surface_light=volumes"};
  for (const std::string& how : ways)
    expect_bdpt(GetParam(), "mcrt,radius=0.03,disk_scale=1,keep=1," + how, 64, ways.size() * suite().size());
}

INSTANTIATE_TEST_SUITE_P(SlowScenes, McrtAgreementEverywhere, ::testing::ValuesIn(suite()),
                         [](const auto& instance) { return test_name(instance.param.name); });

// --- the pass structure ---------------------------------------------------------------------------------------------

Film render_mcrt(const std::string& settings, uint32_t samples, int threads = 2,
                 const std::string& xml = suite_scene("lamp in fog, any length").xml) {
  return render_samples(xml, "mcrt,radius=0.1," + settings, samples, threads);
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
