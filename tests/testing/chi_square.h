#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "core/rng.h"
#include "core/vector.h"

namespace turbid::testing {

/// Do samples follow the density that a sampler claims? Pearson's chi-square test: a histogram of the samples against
/// the integral of the density over each cell. The p-value is the probability that a right sampler looks at least this
/// wrong.
///
/// Samplers may fail (return nothing): failures are one more cell, whose expected mass is 1 minus the integral of the
/// density, so the density must integrate to the success rate. A density whose integral exceeds 1 gives p = 0.
struct ChiSquareResult {
  double p_value = 0;
  int degrees = 0;     ///< degrees of freedom after pooling
  double mass = 0;     ///< integral of the density over the domain
  std::string report;  ///< says in words what was found, for EXPECT_TRUE(...) << result.report
};

struct ChiSquareSettings {
  int theta_bins = 16;  ///< sphere: uniform in the angle to +z, even so that the horizon is an edge; square: along x
  int phi_bins = 32;    ///< sphere: uniform in azimuth; square: along y; unused for intervals
  int interval_bins = 100;  ///< intervals only
  int samples = 100'000;
  uint64_t seed = 1;
  double min_expected = 5;  ///< cells that expect fewer samples are pooled
};

/// Directions on the unit sphere; pdf in 1/sr. The density may be peaked: it is integrated adaptively, and more finely
/// where the histogram disagrees.
ChiSquareResult chi_square_sphere(const std::function<std::optional<Vec3>(Rng&)>& sample,
                                  const std::function<double(const Vec3&)>& pdf_w,
                                  const ChiSquareSettings& settings = {});

/// Numbers in [low, high]; pdf per unit length. Samples outside count as wrong.
ChiSquareResult chi_square_interval(const std::function<std::optional<double>(Rng&)>& sample,
                                    const std::function<double(double)>& pdf, double low, double high,
                                    const ChiSquareSettings& settings = {});

/// Points in the unit square; pdf per unit area. Samples outside count as wrong.
ChiSquareResult chi_square_square(const std::function<std::optional<Vec2>(Rng&)>& sample,
                                  const std::function<double(const Vec2&)>& pdf_a,
                                  const ChiSquareSettings& settings = {});

/// Significance 0.01 for a family of `number_of_tests` tests (Sidak 1967): one test passes when its p-value is at least
/// 1 - (1 - 0.01)^(1/n), so that the whole family of right samplers fails with probability 0.01.
bool passes(const ChiSquareResult& result, int number_of_tests = 1);

/// Integral over a box [x0,x1] x [y0,y1] by nested Gauss-Legendre quadrature (5 x 5 points a box), each box split in
/// four until its parts agree with it within `tolerance` (absolute). At least `min_depth` and at most `max_depth`
/// splits.
double integrate_box(const std::function<double(double, double)>& f, double x0, double x1, double y0, double y1,
                     double tolerance, int min_depth = 0, int max_depth = 9);
/// The same over an interval, split in two.
double integrate_interval(const std::function<double(double)>& f, double x0, double x1, double tolerance,
                          int min_depth = 0, int max_depth = 18);
/// Integral of f over the unit sphere, or over part of it: theta from +z in [theta0, theta1].
double integrate_sphere(const std::function<double(const Vec3&)>& f, double tolerance = 1e-6, double theta0 = 0,
                        double theta1 = 3.14159265358979323846);

}  // namespace turbid::testing
