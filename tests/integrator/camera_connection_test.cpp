// The ways in which `ptracer` finds the last collision before the sensor: all of them against `bdpt`.
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
  return result;
}

class CameraConnections : public ::testing::TestWithParam<SuiteScene> {};

TEST_P(CameraConnections, AgreeWithBdpt) {
  const SuiteScene& scene = GetParam();
  const Observation reference = observe(scene.xml, {"bdpt", 24 * scene.effort, 1, 1}, 8);
  for (const char* technique : {"once_more", "mis", "equiangular", "once_more,sampling=seed", "mis,sampling=seed"}) {
    const Agreement agreement = compare(
        reference,
        observe(scene.xml, {std::string("ptracer,camera_connection=") + technique, 48 * scene.effort, 1, 2}, 8));
    EXPECT_EQ(agreement.cannot, "");
    EXPECT_TRUE(agreement.accepted(5 * scenes().size())) << technique << "\n" << agreement.report();
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, CameraConnections, ::testing::ValuesIn(scenes()), [](const auto& instance) {
  std::string name = instance.param.name;
  for (char& c : name) c = std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
  return name;
});

}  // namespace
}  // namespace turbid::testing
