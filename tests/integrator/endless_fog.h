// A point light over the line of sight in fog without end, single scattering: what kernels make of it, by quadrature.
#pragma once
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "integrator/agreement.h"
#include "integrator/suite.h"

namespace turbid::testing::fog {

inline constexpr double kSigmaT = 0.25, kSigmaS = 0.2, kG = 0.3, kFar = 40;

/// A point light at height 1 over the line of sight, in fog without end; single scattering, one thin pencil of rays.
inline std::string endless_fog(int pixels) {
  return R"(<scene version="3.0.0"><integrator type="volpath"><integer name="max_scattering" value="1"/></integrator>
  <sensor type="perspective"><float name="fov" value="0.2"/><float name="near_clip" value="0"/><transform name="to_world">
  <lookat origin="0, -3, 0" target="0, 0, 0" up="0, 0, 1"/></transform><film type="hdrfilm">)" +
         pieces::integer("width", pixels) + pieces::integer("height", pixels) + R"(<rfilter type="box"/></film></sensor>
  <emitter type="point"><point name="position" value="0, 0, 1"/><rgb name="intensity" value="1"/></emitter>)" +
         pieces::ball("0, 0, 0", static_cast<float>(kFar),
                      R"(<bsdf type="null"/>)" +
                          pieces::medium("interior", "0.25, 0.25, 0.25", "0.8, 0.8, 0.8", static_cast<float>(kG))) +
         "</scene>";
}

/// What the middle ray sees of its point at distance t: sigma_s T f E at `p`, whose light comes from above.
inline double seen_of(double t, const Imath::V3d& p, double length, const Imath::V3d& travels) {
  const double mu = -travels.y / travels.length();  // the sensor looks along +y
  const double f = (1 - kG * kG) / (4 * std::numbers::pi * std::pow(1 + kG * kG - 2 * kG * mu, 1.5));
  return kSigmaS * f * std::exp(-kSigmaT * (t + length)) / (p - Imath::V3d(0, 0, 1)).length2();
}
inline double seen_at(double t, const Imath::V3d& p) {
  const Imath::V3d travels = p - Imath::V3d(0, 0, 1);
  return seen_of(t, p, travels.length(), travels);
}
inline Imath::V3d on_ray(double t) { return {0, t - 3, 0}; }

/// int_0^far kernel(t) dt by the midpoint rule.
template <class Kernel>
double along_ray(const Kernel& kernel, double step) {
  double sum = 0;
  for (double t = step / 2; t < 20; t += step) sum += kernel(t) * step;
  return sum;
}

inline double truth() {
  return along_ray([](double t) { return seen_at(t, on_ray(t)); }, 1e-3);
}

/// The mean over the cylinder's disks of radius R across the ray.
inline double cylinder_expectation(double radius) {
  constexpr int kRings = 24, kAngles = 24;
  return along_ray(
      [&](double t) {
        double sum = 0;
        for (int i = 0; i < kRings; ++i)
          for (int k = 0; k < kAngles; ++k) {
            const double r = radius * std::sqrt((i + 0.5) / kRings), phi = 2 * std::numbers::pi * (k + 0.5) / kAngles;
            sum += seen_at(t, on_ray(t) + Imath::V3d(r * std::cos(phi), 0, r * std::sin(phi)));
          }
        return sum / (kRings * kAngles);
      },
      0.01);
}

/// Light that passes within R of the sphere's centre, sin theta = R/r off the line from the light: intensity times
/// solid angle over pi R^2, attenuated up to where it passes.
inline double sphere_expectation(double radius) {
  constexpr int kCones = 24, kAngles = 24;
  return along_ray(
      [&](double t) {
        const Imath::V3d from = on_ray(t) - Imath::V3d(0, 0, 1);
        const double r = from.length(), least_cosine = std::sqrt(1 - sqr(radius / r));
        const Imath::V3d axis = from / r, u = axis.cross(Imath::V3d(1, 0, 0)).normalized(), v = axis.cross(u);
        const double solid_angle = 2 * std::numbers::pi * (1 - least_cosine);
        double sum = 0;
        for (int i = 0; i < kCones; ++i)
          for (int k = 0; k < kAngles; ++k) {
            const double cosine = 1 - (1 - least_cosine) * (i + 0.5) / kCones, sine = std::sqrt(1 - sqr(cosine));
            const double phi = 2 * std::numbers::pi * (k + 0.5) / kAngles;
            const Imath::V3d ray = axis * cosine + (u * std::cos(phi) + v * std::sin(phi)) * sine;
            sum += seen_of(t, on_ray(t), r * cosine, ray) * r * r;
          }
        return sum / (kCones * kAngles) * solid_angle / (std::numbers::pi * sqr(radius));
      },
      0.01);
}

inline double slope_of(double (*expectation)(double), double radius) {
  return std::log2((expectation(radius) - truth()) / (expectation(radius / 2) - truth()));
}

/// How much is spent on a bias: images, their pixels across, and the light paths for each pixel. Light alone makes the
/// noise of cylinders; spheres need many walks from the sensor, too.
struct Effort {
  uint32_t samples;
  int pixels, light_paths;
};
struct Estimate {
  double mean, error;
};
/// `contestant`: an integrator with its settings, but for the radius and the light paths.
inline Estimate estimate(const std::string& contestant, double radius, const Effort& effort) {
  const std::string whole = fmt::format("{},radius={},keep=1,light_paths={}", contestant, radius, effort.light_paths);
  const Observation seen = observe(endless_fog(effort.pixels), {whole, effort.samples, 1, 7}, 16);
  return {seen.all.mean(0, 0), std::sqrt(seen.all.variance(0, 0) / kPasses)};
}

inline void expect_expectation(const std::string& contestant, double radius, const Effort& effort,
                               double (*expectation)(double)) {
  const Estimate found = estimate(contestant, radius, effort);
  const double expected = expectation(radius), bias = expected / truth() - 1;
  std::printf("%-26s radius %.2f: bias %8.5f by quadrature, %8.5f +- %.5f found\n", contestant.c_str(), radius, bias,
              found.mean / truth() - 1, found.error / truth());
  EXPECT_LT(std::abs(found.mean - expected), 4 * found.error) << contestant << " " << radius;
  EXPECT_GT(std::abs(1.1 * found.mean - expected), 4 * found.error) << "too noisy to notice an error of a tenth";
}

}  // namespace turbid::testing::fog
