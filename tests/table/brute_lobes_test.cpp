// Lobes of the exact table as a whole against a plain walk: NUMERICS 8 asks for 2 % RMS weighed by energy, noise, cells
// and bands together.
#include <gtest/gtest.h>

#include <numbers>

#include "core/gauss_legendre.h"
#include "core/parallel.h"
#include "table/lobe_field.h"
#include "table/plain_photons.h"
#include "table/tables_for_tests.h"

namespace turbid::testing {
namespace {

using Imath::V3d;
constexpr double kPiD = std::numbers::pi;

/// Cells of places and directions, coarser than the table's: 14 shells with 10 rings each, 12 x 4 directions about the
/// line from the source, finer outwards.
struct Bins {
  static constexpr int kShells = 14, kRings = 10, kPolar = 12, kAzimuths = 4;
  static constexpr size_t kDirections = size_t{kPolar} * kAzimuths, kCells = size_t{kShells} * kRings;

  double outer;  ///< mean free paths
  double shell(double i) const { return 0.3 * std::expm1(i / kShells * std::log1p(outer / 0.3)); }
  /// Finer ahead.
  static double ring(double j) { return std::cos(kPiD * sqr(j / kRings)); }
  static double polar(double k) { return kPiD * sqr(k / kPolar); }

  /// -1: beyond.
  int find(const V3d& x, const V3d& w) const {
    const double r = x.length(), i = kShells * std::log1p(r / 0.3) / std::log1p(outer / 0.3);
    if (!(i < kShells) || !(r > 0)) return -1;
    const V3d radial = x / r, axis(0, 0, 1);
    const double j = kRings * std::sqrt(std::acos(std::clamp(radial.z, -1.0, 1.0)) / kPiD);
    const double k = kPolar * std::sqrt(std::acos(std::clamp(radial.dot(w), -1.0, 1.0)) / kPiD);
    // The sagittal plane's direction away from the axis.
    const V3d across = (radial * radial.z - axis).normalized(), side = w - radial * radial.dot(w);
    const double phi = std::acos(std::clamp(side.dot(across) / std::max(side.length(), 1e-12), -1.0, 1.0));
    const auto index = [](double value, int count) { return std::clamp(static_cast<int>(value), 0, count - 1); };
    return ((index(i, kShells) * kRings + index(j, kRings)) * kPolar + index(k, kPolar)) * kAzimuths +
           index(phi / kPiD * kAzimuths, kAzimuths);
  }
};

/// Light in every bin, by photons.
std::vector<double> walk(const Bins& bins, double g, double albedo, uint64_t seed, int photons) {
  std::vector<double> light(Bins::kCells * Bins::kDirections);
  Rng rng(seed);
  for (int p = 0; p < photons; ++p)
    follow_photon(g, albedo, rng, [&](const V3d& x, const V3d& out, double weight) {
      if (const int bin = bins.find(x, out); bin >= 0) light[static_cast<size_t>(bin)] += weight / photons;
    });
  return light;
}

/// The same of a field, by quadrature in each bin.
std::vector<double> integrate(const Bins& bins, const LobeField& field) {
  const GaussLegendre rule(3);
  std::vector<double> light(Bins::kCells * Bins::kDirections);
  parallel_for(Bins::kCells, [&](size_t cell) {
    const int i = static_cast<int>(cell) / Bins::kRings, j = static_cast<int>(cell) % Bins::kRings;
    for (size_t a = 0; a < rule.size(); ++a)
      for (size_t b = 0; b < rule.size(); ++b) {
        const double r = std::lerp(bins.shell(i), bins.shell(i + 1), rule.node(a));
        const double c = std::lerp(Bins::ring(j), Bins::ring(j + 1), rule.node(b));
        const double volume = rule.weight(a) * (bins.shell(i + 1) - bins.shell(i)) * r * r * rule.weight(b) *
                              (Bins::ring(j) - Bins::ring(j + 1)) * 2 * kPiD;
        const double sine = std::sqrt(std::max(0.0, 1 - c * c));
        const V3d radial(sine, 0, c), across(c, 0, -sine);
        for (size_t d = 0; d < Bins::kDirections; ++d) {
          const int k = static_cast<int>(d) / Bins::kAzimuths, m = static_cast<int>(d) % Bins::kAzimuths;
          for (size_t u = 0; u < rule.size(); ++u)
            for (size_t v = 0; v < rule.size(); ++v) {
              const double theta = std::lerp(Bins::polar(k), Bins::polar(k + 1), rule.node(u));
              const double phi = kPiD * (m + rule.node(v)) / Bins::kAzimuths;
              // Both sides of the sagittal plane.
              const double solid = rule.weight(u) * (Bins::polar(k + 1) - Bins::polar(k)) * std::sin(theta) *
                                   rule.weight(v) * 2 * kPiD / Bins::kAzimuths;
              const V3d w = radial * std::cos(theta) + across * (std::sin(theta) * std::cos(phi)) +
                            V3d(0, std::sin(theta) * std::sin(phi), 0);
              light[cell * Bins::kDirections + d] +=
                  volume * solid * static_cast<double>(field.eval(Vec3(radial * r), {0, 0, 1}, Vec3(w)));
            }
        }
      }
  });
  return light;
}

struct LobeError {
  double all;     ///< noise of the walk taken off: its two halves are independent
  double energy;  ///< share of it that is looked at
};

/// sqrt(sum_c E_c |dL_c|^2 / |L_c|^2 / sum_c E_c) over cells of places, as in the study behind NUMERICS 8.
LobeError compare(const std::vector<double>& first, const std::vector<double>& second, const std::vector<double>& table,
                  double albedo) {
  double energy = 0, error = 0;
  for (size_t cell = 0; cell < Bins::kCells; ++cell) {
    double held = 0, square = 0, difference = 0;
    for (size_t d = 0; d < Bins::kDirections; ++d) {
      // Radiance: light over the bin's solid angle.
      const int k = static_cast<int>(d) / Bins::kAzimuths;
      const double solid = std::cos(Bins::polar(k)) - std::cos(Bins::polar(k + 1));
      const size_t bin = cell * Bins::kDirections + d;
      held += table[bin];
      square += table[bin] * table[bin] / solid;
      difference += (first[bin] - table[bin]) * (second[bin] - table[bin]) / solid;
    }
    if (!(square > 0)) continue;
    energy += held;
    error += held * difference / square;
  }
  return {std::sqrt(std::max(0.0, error / energy)), energy / (std::pow(albedo, 3) / (1 - albedo))};
}

class SlowBruteLobes : public ::testing::TestWithParam<float> {};

TEST_P(SlowBruteLobes, WithinTwoPercent) {
  const float g = GetParam();
  const ScatteringTable table = standard_table(g);
  for (const double albedo : {0.5, 0.9, 0.99, 0.999}) {
    const LobeField field(table, SourceKind::kCollision, albedo);
    const Bins bins{std::min(100.0, 6 / field.far_field().decay())};
    const int photons = static_cast<int>(std::max(20'000.0, 4e6 * (1 - albedo)));
    std::array<std::vector<double>, 2> halves;
    const auto told = static_cast<double>(g);
    parallel_for(2, [&](size_t h) { halves[h] = walk(bins, told, albedo, 11 + h, photons); });
    const std::vector<double> found = integrate(bins, field);
    const LobeError error = compare(halves[0], halves[1], found, albedo);
    std::printf("g %.1f, albedo %.3f: lobes %.2f %%, looked at %.3f of the energy\n", told, albedo, 100 * error.all,
                error.energy);
    EXPECT_LT(error.all, 0.02) << g << " " << albedo;
    if (albedo > 0.9) continue;
    // Another phase function is noticed.
    for (size_t h = 0; h < 2; ++h) halves[h] = walk(bins, told + 0.04, albedo, 11 + h, photons);
    EXPECT_GT(compare(halves[0], halves[1], found, albedo).all, 0.03) << g << " " << albedo;
  }
}
INSTANTIATE_TEST_SUITE_P(SlowLobes, SlowBruteLobes, ::testing::Values(0.0f, 0.3f, 0.7f, 0.9f));

}  // namespace
}  // namespace turbid::testing
