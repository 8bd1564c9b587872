// The spheres that walks from the sensor leave, as a point process: its mean is the integral that it stands for, and
// its variance that of a compound Poisson process which ends at the real collision.
#include <gtest/gtest.h>

#include "gathering/sensor_gatherer.h"
#include "scene/loader.h"

namespace turbid::testing {
namespace {

/// A line of sight through a slab of fog of depth 2 between invisible walls, with nothing else.
Scene slab(const std::string& sigma_t) {
  return Scene(load_scene_from_string(R"(<scene version="3.0.0"><sensor type="orthographic"><transform name="to_world">
    <lookat origin="0, 0, -3" target="0, 0, 0" up="0, 1, 0"/></transform></sensor>
    <shape type="cube"><transform name="to_world"><scale x="50" y="50" z="1"/></transform><bsdf type="null"/>
    <medium name="interior" type="homogeneous"><rgb name="sigma_t" value=")" +
                                          sigma_t + R"("/><rgb name="albedo" value="0.5"/></medium></shape></scene>)",
                                      "slab", {})
                   .parts);
}

/// Light as it might be, at depth t.
double light_at(double t) { return 1 + t * t; }
constexpr double kDepth = 2;

struct Moments {
  double mean[kChannels] = {}, variance[kChannels] = {}, spheres = 0;
};

/// Of sum W(t_i) light(t_i) over the spheres of one walk.
Moments moments(const Scene& scene, float q, int walks) {
  GatherSettings gather;
  gather.q = q;
  PathSettings path;
  const GatherPlan plan{scene, path, gather, {0.1f, 0, 0}, {0.1f, 0, 0}, false};
  Sampler sampler(SamplerKind::kIndependent, 4);
  SampleCounters counters;
  SensorGatherer gatherer(plan, sampler, counters);
  CameraWalk<SensorGatherer> walk(scene, path, sampler, counters, gatherer);
  const SensorRay camera = scene.sensor().sample_ray({0.5f, 0.5f}, {0.5f, 0.5f});
  Moments result;
  double squares[kChannels] = {};
  for (int i = 0; i < walks; ++i) {
    sampler.start(static_cast<uint64_t>(i), 0);
    Gathering left;
    gatherer.begin(0, camera, left);
    walk.run(camera);
    double sum[kChannels] = {};
    for (const GatherVolume& sphere : left.volumes)
      for (int c = 0; c < kChannels; ++c)
        sum[c] += static_cast<double>(sphere.weight[c]) * light_at(static_cast<double>(sphere.origin.z) + 1);
    result.spheres += static_cast<double>(left.volumes.size()) / walks;
    for (int c = 0; c < kChannels; ++c) {
      result.mean[c] += sum[c] / walks;
      squares[c] += sum[c] * sum[c] / walks;
    }
  }
  for (int c = 0; c < kChannels; ++c) result.variance[c] = squares[c] - sqr(result.mean[c]);
  return result;
}

/// int_0^depth T(t) light(t) dt.
double integral(double sigma) {
  double sum = 0;
  constexpr int kSteps = 100000;
  for (int i = 0; i < kSteps; ++i) {
    const double t = (i + 0.5) * kDepth / kSteps;
    sum += std::exp(-sigma * t) * light_at(t) * kDepth / kSteps;
  }
  return sum;
}

/// q A + (1 - q) B - mean^2 with g = light / sigma: A = int sigma e^(-sigma t) g^2 dt and
/// B = 2 int int_(s < t) sigma^2 e^(-sigma t) g(s) g(t) ds dt.
double compound_variance(double sigma, double q) {
  double a = 0, b = 0, before = 0;  // before: int_0^t sigma g
  constexpr int kSteps = 100000;
  constexpr double kStep = kDepth / kSteps;
  for (int i = 0; i < kSteps; ++i) {
    const double t = (i + 0.5) * kStep, g = light_at(t) / sigma, density = sigma * std::exp(-sigma * t);
    a += density * g * g * kStep;
    b += 2 * density * g * (before + sigma * g * kStep / 2) * kStep;
    before += sigma * g * kStep;
  }
  return q * a + (1 - q) * b - sqr(integral(sigma));
}

TEST(StringsOfSpheres, HaveTheMomentsOfACompoundPoissonProcess) {
  constexpr double kSigma = 0.6;
  constexpr int kWalks = 100000;
  const Scene scene = slab("0.6, 0.6, 0.6");
  for (const float q : {1.0f, 0.5f, 0.2f, 0.05f}) {
    const Moments found = moments(scene, q, kWalks);
    const double variance = compound_variance(kSigma, static_cast<double>(q));
    EXPECT_NEAR(found.mean[0], integral(kSigma), 4 * std::sqrt(variance / kWalks)) << q;
    EXPECT_NEAR(found.variance[0] / variance, 1, 0.02) << q;
    EXPECT_GT(std::abs(found.variance[0] / (variance * 1.05) - 1), 0.02) << "an error of a twentieth shows";
    EXPECT_NEAR(found.spheres, (1 - std::exp(-kSigma * kDepth)) / static_cast<double>(q),
                0.02 / static_cast<double>(q));
  }
}

TEST(StringsOfSpheres, ServeAllChannelsAtOnce) {
  const double sigma[] = {0.1, 0.6, 3};
  const Scene scene = slab("0.1, 0.6, 3");
  for (const float q : {1.0f, 0.3f, 0.05f}) {
    constexpr int kWalks = 200000;
    const Moments found = moments(scene, q, kWalks);
    for (int c = 0; c < kChannels; ++c)
      EXPECT_NEAR(found.mean[c], integral(sigma[c]), 4 * std::sqrt(found.variance[c] / kWalks)) << q << " " << c;
  }
}

}  // namespace
}  // namespace turbid::testing
