// The ways in which `ptracer` finds the last collision before the sensor, and `volpath` the one next to a light: all of
// them against `bdpt`.
#include <gtest/gtest.h>

#include "integrator/agreement.h"
#include "integrator/suite.h"

namespace turbid::testing {
namespace {

using namespace pieces;

/// Scenes that the techniques differ in: open and closed directions at x0, several media, all kinds of lights.
std::vector<SuiteScene> scenes() {
  std::vector<SuiteScene> result;
  for (const SuiteScene& scene : suite())
    for (const char* name :
         {"lamp in fog, any length", "point in fog", "spot in fog", "sky on fog", "sun on fog", "laser in fog",
          "chromatic medium", "heterogeneous medium", "rough glass with murk", "caustic into fog", "thin lens",
          "sensor inside the medium", "priorities and a world medium", "several media in turn"})
      if (scene.name == name) result.push_back(scene);
  // One-sided lights, of which x0 sees another part than x1, and glossy x0 (mixed lobes).
  result.push_back({"panels in fog", scene(kFloor + fog() + R"(<shape type="rectangle"><transform name="to_world">
      <scale value="0.5"/><rotate x="1" angle="200"/><translate x="0.4" y="0.2" z="1.6"/></transform>
      <emitter type="area"><rgb name="radiance" value="9, 8, 7"/></emitter></shape><shape type="cube">
      <transform name="to_world"><scale value="0.4"/><translate x="-0.8" y="0.3" z="0.5"/></transform>
      <bsdf type="roughplastic"><float name="alpha" value="0.2"/></bsdf>
      <emitter type="area"><rgb name="radiance" value="0.5, 1, 2"/></emitter></shape>)")});
  return result;
}

using Techniques = std::vector<std::string>;
const Techniques kAll = {"equiangular",
                         "product",
                         "once_more",
                         "mis",
                         "once_more,sampling=seed",
                         "mis,sampling=seed",
                         "once_more,sampling=geometry"};

/// `integrator` names all but the technique. `scale`: more samples.
void expect_agreement_of(const Techniques& techniques, const std::string& integrator, const SuiteScene& scene,
                         uint32_t scale = 1, double brightness = 1) {
  const uint32_t effort = scale * scene.effort;
  const Observation reference = observe(scene.xml, {"bdpt", 24 * effort, 1, 1}, 8);
  for (const std::string& technique : techniques) {
    const Contestant contestant{integrator + technique, 32 * effort, brightness, 2};
    const Agreement agreement = compare(reference, observe(scene.xml, contestant, 8));
    EXPECT_EQ(agreement.cannot, "");
    const bool accepted = agreement.accepted(2 * kAll.size() * scenes().size());
    EXPECT_EQ(accepted, brightness == 1) << technique << "\n" << agreement.report();
  }
}

class Connections : public ::testing::TestWithParam<SuiteScene> {};
class SlowConnections : public ::testing::TestWithParam<SuiteScene> {};

/// `volpath` sees no beams.
bool has_beam(const SuiteScene& scene) { return scene.name.starts_with("laser"); }

TEST_P(Connections, ToTheSensorAgreeWithBdpt) {
  expect_agreement_of({"mis"}, "ptracer,camera_connection=", GetParam());
}
TEST_P(Connections, ToLightsAgreeWithBdpt) {
  if (!has_beam(GetParam())) expect_agreement_of({"mis"}, "volpath,nee=", GetParam());
}
TEST(AllConnections, AgreeWithBdpt) {
  const SuiteScene scene = scenes().front();
  expect_agreement_of(kAll, "ptracer,camera_connection=", scene);
  expect_agreement_of(kAll, "volpath,nee=", scene);
  expect_agreement_of({"mis"}, "volpath,nee=", scene, 1, 1.1);  // planted
}
TEST_P(SlowConnections, AgreeWithBdpt) {
  expect_agreement_of(kAll, "ptracer,camera_connection=", GetParam(), 2);
  if (!has_beam(GetParam())) expect_agreement_of(kAll, "volpath,nee=", GetParam(), 2);
}

const auto kNames = [](const auto& instance) {
  std::string name = instance.param.name;
  for (char& c : name) c = std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
  return name;
};
INSTANTIATE_TEST_SUITE_P(Scenes, Connections, ::testing::ValuesIn(scenes()), kNames);
INSTANTIATE_TEST_SUITE_P(Slow, SlowConnections, ::testing::ValuesIn(scenes()), kNames);

}  // namespace
}  // namespace turbid::testing
