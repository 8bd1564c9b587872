// Each way to merge photons alone has the bias of its kernel, which falls with the square of the radius where light is
// smooth, and is a loss in proportion to the radius at boundaries.
#include "integrator/endless_fog.h"

namespace turbid::testing {
namespace {

using namespace fog;

/// The mean over balls around collisions (P-P3D).
double ball_expectation(double radius) {
  constexpr int kShells = 6, kCosines = 8, kAngles = 8;
  return along_ray(
      [&](double t) {
        double sum = 0;
        for (int i = 0; i < kShells; ++i)
          for (int j = 0; j < kCosines; ++j)
            for (int k = 0; k < kAngles; ++k) {
              const double r = radius * std::cbrt((i + 0.5) / kShells), z = 2 * (j + 0.5) / kCosines - 1;
              const double phi = 2 * std::numbers::pi * (k + 0.5) / kAngles, across = r * std::sqrt(1 - z * z);
              sum += seen_at(t, on_ray(t) + Imath::V3d(across * std::cos(phi), across * std::sin(phi), r * z));
            }
        return sum / (kShells * kCosines * kAngles);
      },
      0.01);
}

/// Beams that cross the ray at t in the distance u, on the common perpendicular: the ray of light and that to the sensor
/// are h = sqrt(1 - u^2) apart at the foot of the light, so that dw = sin dt du / s^2 (B-B1D).
double crossing_expectation(double radius) {
  constexpr int kSteps = 64;
  return along_ray(
      [&](double t) {
        double sum = 0;
        for (int i = 0; i < kSteps; ++i) {
          const double u = radius * (i + 0.5) / kSteps, along = t - 3, height = std::sqrt(1 - u * u);
          const double s = std::sqrt(height * height + along * along);
          // As if straight below at the height of the beam: only lengths and the angle count.
          sum += seen_of(t, Imath::V3d(0, along, 1 - height), s, Imath::V3d(0, along, -height));
        }
        return sum / kSteps;
      },
      0.01);
}

const std::string kPB = "upbp,techniques=pb2d,sensor_beams=long", kBB =
    "upbp,techniques=bb1d,sensor_beams=long,photon_beams=long,beam_paths=1000000000",
                  kBP = "upbp,techniques=bp2d,photon_beams=long,beam_paths=1000000000", kPP = "upbp,techniques=pp3d";

TEST(PhotonBias, FallsWithTheSquareOfTheRadius) {
  for (auto* expectation : {ball_expectation, cylinder_expectation, sphere_expectation, crossing_expectation})
    EXPECT_NEAR(slope_of(expectation, 0.1), 2, 0.02);
}

TEST(PhotonBias, IsThatOfTheKernel) {
  expect_expectation(kPB, 0.8, {1, 1, 20000}, cylinder_expectation);
  expect_expectation(kBB, 0.8, {1, 1, 10000}, crossing_expectation);
  expect_expectation(kBB, 0.1, {1, 1, 20000}, crossing_expectation);
  expect_expectation(kBP, 0.8, {16, 4, 64}, sphere_expectation);
  expect_expectation(kPP, 0.8, {16, 4, 64}, ball_expectation);
}

TEST(SlowPhotonBias, IsThatOfTheKernel) {
  for (const double radius : {0.8, 0.4, 0.2, 0.1})
    for (const char* kind : {"", ",sensor_beams=short"})
      expect_expectation("upbp,techniques=pb2d" + std::string(*kind ? kind : ",sensor_beams=long"), radius,
                         {32, 1, 80000}, cylinder_expectation);
  for (const double radius : {0.8, 0.4, 0.2, 0.05}) expect_expectation(kBB, radius, {32, 1, 40000}, crossing_expectation);
  for (const double radius : {0.8, 0.4, 0.2}) expect_expectation(kBP, radius, {256, 8, 64}, sphere_expectation);
  for (const double radius : {0.8, 0.4, 0.2}) expect_expectation(kPP, radius, {512, 8, 64}, ball_expectation);
}

}  // namespace
}  // namespace turbid::testing
