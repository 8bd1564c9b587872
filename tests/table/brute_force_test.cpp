#include <gtest/gtest.h>

#include <array>
#include <numbers>

#include "core/gauss_legendre.h"
#include "table/lobe_field.h"
#include "table/plain_photons.h"
#include "table/tables_for_tests.h"

/// The tables against a walk written for this test alone: starts anew for every photon, in double precision, by other
/// formulas, and looks at where light goes after its last deflection.
namespace turbid::testing {
namespace {

using Imath::V3d;
constexpr double kPiD = std::numbers::pi;

constexpr std::array kShells = {0.0, 0.4, 1.5, 4.0, 10.0, 25.0};
constexpr size_t kFunctions = 6;
/// What is asked of the light in a shell: functions of its direction and place.
std::array<double, kFunctions> functions(const V3d& x, const V3d& w) {
  const V3d r = x.normalized();
  const double a = w.dot(r), z = w.z;
  return {1, a, z, z * z, a * z, r.z * (z > 0.9 ? 1 : 0)};
}

struct Statistics {
  std::array<std::array<double, kFunctions>, kShells.size() - 1> sum{}, squares{};
};

Statistics walk(double g, double albedo, bool ray, int photons) {
  Statistics result;
  Rng rng(99);
  for (int p = 0; p < photons; ++p) {
    std::array<std::array<double, kFunctions>, kShells.size() - 1> mine{};
    follow_photon(
        g, albedo, rng,
        [&](const V3d& x, const V3d& out, double weight) {
          const double r = x.length();
          for (size_t s = 0; s + 1 < kShells.size(); ++s)
            if (r >= kShells[s] && r < kShells[s + 1]) {
              const auto f = functions(x, out);
              for (size_t k = 0; k < kFunctions; ++k) mine[s][k] += weight * f[k];
            }
        },
        ray);
    for (size_t s = 0; s < mine.size(); ++s)
      for (size_t k = 0; k < kFunctions; ++k) {
        result.sum[s][k] += mine[s][k] / photons;
        result.squares[s][k] += mine[s][k] * mine[s][k] / photons;
      }
  }
  return result;
}

/// The same of a table, by quadrature over places and directions.
std::array<double, kFunctions> integrate(const LobeField& field, double from, double to) {
  const GaussLegendre radii(8), angles(20), polar(24);
  constexpr int kAzimuths = 24;
  std::array<double, kFunctions> sum{};
  for (size_t i = 0; i < radii.size(); ++i)
    for (size_t j = 0; j < angles.size(); ++j) {
      const double r = from + (to - from) * radii.node(i), y = angles.node(j), theta = kPiD * y * y;
      const double volume =
          radii.weight(i) * (to - from) * angles.weight(j) * 2 * kPiD * y * std::sin(theta) * 2 * kPiD * r * r;
      const V3d x(r * std::sin(theta), 0, r * std::cos(theta));
      for (size_t k = 0; k < polar.size(); ++k)
        for (int a = 0; a < kAzimuths; ++a) {
          // Finer forward, where lobes are narrow.
          const double v = polar.node(k), out = kPiD * v * v, phi = kPiD * (a + 0.5) / kAzimuths;
          const double solid = polar.weight(k) * 2 * kPiD * v * std::sin(out) * 2 * kPiD / kAzimuths;
          const V3d w(std::sin(out) * std::cos(phi), std::sin(out) * std::sin(phi), std::cos(out));
          const double value = static_cast<double>(field.eval(Vec3(x), {0, 0, 1}, Vec3(w))) * volume * solid;
          const auto f = functions(x, w);
          for (size_t n = 0; n < kFunctions; ++n) sum[n] += value * f[n];
        }
    }
  return sum;
}

/// The largest deviation over shells and functions, over the tolerance: 4 standard errors of walk and table together,
/// and 1.2 % of the shell's energy for interpolation and bands. The table has 200,000 samples per bin, of which
/// overlapping walks make about a third independent; a bin's weight is about 1.
double worst(float g, double albedo, SourceKind kind, double told_g, bool told_ray) {
  const LobeField field(small_table(g), kind, albedo);
  constexpr int kPhotons = 300000;
  const Statistics walked = walk(told_g, albedo, told_ray, kPhotons);
  double result = 0;
  for (size_t s = 0; s + 1 < kShells.size(); ++s) {
    const auto found = integrate(field, kShells[s], kShells[s + 1]);
    for (size_t k = 0; k < kFunctions; ++k) {
      const double error =
          std::sqrt((walked.squares[s][k] - sqr(walked.sum[s][k])) / kPhotons + walked.sum[s][0] * 3 / 200'000);
      result = std::max(result, std::abs(found[k] - walked.sum[s][k]) / (4 * error + 0.012 * walked.sum[s][0]));
    }
  }
  return result;
}

TEST(BruteForce, TablesMeetAPlainWalk) {
  for (const float g : {0.0f, 0.7f}) {
    const double told = static_cast<double>(g);
    EXPECT_LT(worst(g, 0.9, SourceKind::kCollision, told, false), 1) << g;
    EXPECT_LT(worst(g, 0.9, SourceKind::kRay, told, true), 1) << g;
    EXPECT_LT(worst(g, 0.5, SourceKind::kCollision, told, false), 1) << g;
  }
}

TEST(BruteForce, AnotherWalkIsFound) {
  EXPECT_GT(worst(0.7f, 0.9, SourceKind::kCollision, 0.65, false), 1.5);
  EXPECT_GT(worst(0.7f, 0.9, SourceKind::kCollision, 0.7, true), 1.5);
}

}  // namespace
}  // namespace turbid::testing
