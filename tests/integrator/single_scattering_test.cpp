// `single_scattering = refractive` in bidirectional methods and in those of virtual lights: nothing is counted twice,
// nothing is left out.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "integrator/refractive_scenes.h"

namespace turbid::testing {
namespace {

using namespace pieces;

constexpr int kBlock = 16;  ///< of all pixels: light that is met by chance is rare

std::string lit_ball(const std::string& light) {
  return scene(light + kFloor + bumpy(kGlass + clear()), integer("max_depth", 6));
}

const std::string& lamp_over_ball() {
  static const std::string xml = lit_ball(lamp("0.8, 0.9, 3", 0.5f));
  return xml;
}

/// Sensor and a dull ball in the glass: walks from the light are joined and merged behind V, too.
const std::string& seen_from_within() {
  static const std::string xml = scene(lamp("0.8, 0.9, 3", 0.5f) + kFloor + bumpy(kGlass + clear()) +
                                           ball("0, 0.3, 0.85", 0.2f, R"(<bsdf type="diffuse"/>)"),
                                       integer("max_depth", 5), camera_inside());
  return xml;
}

struct Light {
  double sum = 0, error = 0;  ///< of channels that may be fully correlated
};

Light light_of_order_one(const Observation& seen) {
  Light result;
  for (int c = 0; c < kChannels; ++c) {
    result.sum += seen.orders[1].mean(0, c);
    result.error += std::sqrt(seen.orders[1].variance(0, c) / kPasses);
  }
  return result;
}

/// The light of order 1 that is found by refraction is most of it, so that it would show if it counted twice or never.
void expect_to_notice(const Agreement& agreement) { EXPECT_LT(agreement.ratio_error[1 + 1], 0.08); }

TEST(SingleScattering, ByRefractionIsMostOfItHere) {
  const Light all = light_of_order_one(observe(lamp_over_ball(), {"singlescatter", 16}, kBlock)),
              others = light_of_order_one(observe(lamp_over_ball(), {"singlescatter,method=none", 16}, kBlock));
  EXPECT_LT(others.sum, 0.6 * all.sum);
}

class SingleScatteringOfPaths : public ::testing::TestWithParam<std::string> {};

Agreement compare_with_bdpt(const std::string& way, double brightness = 1) {
  static const Observation reference = observe(lamp_over_ball(), {"bdpt", 64, 1, 1}, kBlock);
  return compare(reference,
                 observe(lamp_over_ball(), {way + ",single_scattering=refractive", 24, brightness, 2}, kBlock));
}

TEST_P(SingleScatteringOfPaths, ByRefractionMakesThePictureOfBdpt) {
  const Agreement agreement = compare_with_bdpt(GetParam());
  EXPECT_TRUE(agreement.accepted(10)) << agreement.report();
  expect_to_notice(agreement);
}

TEST(SingleScattering, ByRefractionIsNotJoinedOrMergedAgain) {
  const Observation reference = observe(seen_from_within(), {"bdpt", 48, 1, 1}, kBlock);
  for (const char* way : {"bdpt", "upbp,techniques=surf+pb2d,radius=0.03,surface_radius=0.02,keep=1"}) {
    const std::string refractive = std::string(way) + ",single_scattering=refractive";
    const Agreement agreement = compare(reference, observe(seen_from_within(), {refractive, 8, 1, 2}, kBlock));
    EXPECT_TRUE(agreement.accepted(2)) << way << "\n" << agreement.report();
    expect_to_notice(agreement);
  }
}

TEST(SingleScattering, HarnessNoticesAPlantedError) { EXPECT_FALSE(compare_with_bdpt("bdpt", 1.3).accepted(10)); }

INSTANTIATE_TEST_SUITE_P(Ways, SingleScatteringOfPaths,
                         ::testing::Values("bdpt", "upbp,techniques=bpt,keep=1",
                                           "upbp,techniques=surf+pb2d,radius=0.03,keep=1",
                                           "upbp,techniques=surf+pp3d,radius=0.1,keep=1,light_paths=4",
                                           "upbp,techniques=surf+bp2d,radius=0.05,keep=1",
                                           "upbp,techniques=surf+bb1d,radius=0.03,keep=1",
                                           "upbp,techniques=bpt+surf+pp3d+pb2d+bp2d+bb1d,radius=0.03,keep=1"),
                         [](const auto& instance) { return test_name(instance.param); });

class SingleScatteringOfLights : public ::testing::TestWithParam<std::string> {};

/// Both leave out the light over short lines: it has no variance (NUMERICS 6).
TEST_P(SingleScatteringOfLights, ByRefractionMakesTheSamePicture) {
  const std::string way = GetParam() + ",light_sampler=all,lights=40,volume_points=2,reuse=1,least_distance=0.3";
  const Observation reference = observe(lamp_over_ball(), {way, 96, 1, 1}, kBlock);
  const Observation found = observe(lamp_over_ball(), {way + ",single_scattering=refractive", 24, 1, 2}, kBlock);
  const Agreement agreement = compare(reference, found);
  EXPECT_TRUE(agreement.accepted(2)) << agreement.report();
  expect_to_notice(agreement);
}

INSTANTIATE_TEST_SUITE_P(Ways, SingleScatteringOfLights, ::testing::Values("vpl", "vrl"),
                         [](const auto& instance) { return test_name(instance.param); });

TEST(SingleScattering, ReachesPointLightsBehindABoundary) {
  const std::string xml = lit_ball(
      R"(<emitter type="point"><point name="position" value="0.8, 0.9, 3"/><rgb name="intensity" value="9"/></emitter>)");
  // What is found in other ways, on the floor after it was scattered, is in both pictures and cancels.
  const auto added_to = [&](const std::string& without, const std::string& with, uint32_t samples, uint64_t seed) {
    const Light some = light_of_order_one(observe(xml, {without, samples, 1, seed}, kBlock)),
                all = light_of_order_one(observe(xml, {with, samples, 1, seed}, kBlock));
    return Light{all.sum - some.sum, all.error};
  };
  const Light followed = added_to("singlescatter,method=none", "singlescatter", 32, 1);
  for (const char* way : {"vpl", "vrl"}) {
    const std::string plain = std::string(way) + ",light_sampler=all,lights=10,least_distance=0.3";
    const Light added = added_to(plain, plain + ",single_scattering=refractive", 16, 2);
    const double error = std::hypot(added.error, followed.error);
    EXPECT_LT(std::abs(added.sum - followed.sum), 4 * error) << way << " adds " << added.sum / followed.sum;
    EXPECT_LT(error, 0.05 * followed.sum) << "too noisy to say anything";
  }
}

}  // namespace
}  // namespace turbid::testing
