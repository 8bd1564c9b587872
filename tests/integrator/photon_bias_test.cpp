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

/// Beams that cross the ray at t in the distance u, on the common perpendicular: the ray of light and that to the
/// sensor are h = sqrt(1 - u^2) apart at the foot of the light, so that dw = sin dt du / s^2 (B-B1D).
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

const std::string kPB = "upbp,techniques=pb2d,sensor_beams=long",
                  kBB = "upbp,techniques=bb1d,sensor_beams=long,photon_beams=long,beam_paths=1000000000",
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
  // Short flights each see a piece of the ray: it takes many of them.
  for (const double radius : {0.8, 0.4, 0.2, 0.1}) {
    expect_expectation(kPB, radius, {32, 1, 20000}, cylinder_expectation);
    expect_expectation("upbp,techniques=pb2d,sensor_beams=short", radius, {32, 8, 160}, cylinder_expectation);
  }
  for (const double radius : {0.8, 0.4, 0.2, 0.05})
    expect_expectation(kBB, radius, {32, 1, 40000}, crossing_expectation);
  for (const double radius : {0.8, 0.4, 0.2}) expect_expectation(kBP, radius, {256, 8, 64}, sphere_expectation);
  for (const double radius : {0.8, 0.4, 0.2}) expect_expectation(kPP, radius, {512, 8, 64}, ball_expectation);
}

// --- kernels that reach past a boundary lose light there
// ---------------------------------------------------------------

constexpr double kThickness = 4;  ///< of a slab, mean free paths

/// Balls around collisions in a slab that is lit and seen straight from above, single scattering, over the truth: light
/// is the mean over the ball, with nothing outside of the slab.
double slab_ratio(double radius) {
  constexpr int kSteps = 8000, kLayers = 60;
  double kernel = 0, exact = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double z = kThickness * (i + 0.5) / kSteps;
    double light = 0;
    for (int k = 0; k < kLayers; ++k) {
      const double u = radius * (2 * (k + 0.5) / kLayers - 1);
      if (z + u > 0 && z + u < kThickness)
        light += 0.75 / (radius * sqr(radius)) * (sqr(radius) - u * u) * std::exp(-z - u) * 2 * radius / kLayers;
    }
    kernel += std::exp(-z) * light;
    exact += std::exp(-2 * z);
  }
  return kernel / exact;
}

std::string slab() {
  return R"(<scene version="3.0.0"><integrator type="volpath"><integer name="max_scattering" value="1"/></integrator>
  <sensor type="perspective"><float name="fov" value="0.5"/><transform name="to_world">
  <lookat origin="0, 0, 9" target="0, 0, 0" up="0, 1, 0"/></transform><film type="hdrfilm">)" +
         pieces::integer("width", 4) + pieces::integer("height", 4) + R"(<rfilter type="box"/></film></sensor>
  <emitter type="directional"><vector name="direction" value="0, 0, -1"/><rgb name="irradiance" value="1"/></emitter>
  <shape type="cube"><transform name="to_world"><scale x="1.2" y="1.2" z="2"/></transform><bsdf type="null"/>)" +
         pieces::medium("interior", "1, 1, 1", "1, 1, 1", 0) + "</shape></scene>";
}

void expect_slab_ratio(double radius, uint32_t samples, int light_paths) {
  const Observation exact = observe(slab(), {"volpath", 256}, 16);
  const std::string how = fmt::format("{},radius={},keep=1,light_paths={}", kPP, radius, light_paths);
  const Observation merged = observe(slab(), {how, samples, 1, 3}, 16);
  const double ratio = merged.all.mean(0, 0) / exact.all.mean(0, 0);
  const double error = ratio * std::sqrt(merged.all.variance(0, 0) / kPasses / sqr(merged.all.mean(0, 0)) +
                                         exact.all.variance(0, 0) / kPasses / sqr(exact.all.mean(0, 0)));
  std::printf("radius %.3f mean free paths: %.4f of the light by quadrature, %.4f +- %.4f found\n", radius,
              slab_ratio(radius), ratio, error);
  EXPECT_LT(std::abs(ratio - slab_ratio(radius)), 4 * error);
  EXPECT_LT(error, 0.04);
}

TEST(PhotonBias, IsALossAtBoundaries) {
  EXPECT_NEAR((1 - slab_ratio(0.02)) / (1 - slab_ratio(0.01)), 2, 0.05) << "in proportion to the radius";
  EXPECT_LT(slab_ratio(0.5), 0.87);
  // The largest radius by default, see default_media_radii.
  EXPECT_GT(slab_ratio(0.015), 0.99);
  expect_slab_ratio(0.5, 16, 64);
}

TEST(SlowPhotonBias, IsALossAtBoundaries) {
  for (const double radius : {0.5, 0.25, 0.12}) expect_slab_ratio(radius, 64, 256);
}

}  // namespace
}  // namespace turbid::testing
