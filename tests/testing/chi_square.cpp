#include "testing/chi_square.h"

#include <algorithm>
#include <array>
#include <numbers>
#include <unsupported/Eigen/SpecialFunctions>
#include <vector>

namespace turbid::testing {
namespace {

constexpr double kSignificance = 0.01;
/// A density may exceed total mass 1 by this much before it is called wrong: float rounding of densities and
/// quadrature.
constexpr double kMassTolerance = 1e-3;

/// Five-point Gauss-Legendre rule on [-1, 1] (Abramowitz & Stegun, table 25.4).
constexpr std::array<double, 5> kNodes = {-0.906179845938664, -0.538469310105683, 0.0, 0.538469310105683,
                                          0.906179845938664};
constexpr std::array<double, 5> kWeights = {0.236926885056189, 0.478628670499366, 0.568888888888889, 0.478628670499366,
                                            0.236926885056189};

struct Box {
  double x0, x1, y0, y1;
};
using Density2 = std::function<double(double, double)>;

double gauss_box(const Density2& f, const Box& b) {
  const double cx = (b.x0 + b.x1) / 2, hx = (b.x1 - b.x0) / 2, cy = (b.y0 + b.y1) / 2, hy = (b.y1 - b.y0) / 2;
  double sum = 0;
  for (size_t i = 0; i < 5; ++i)
    for (size_t j = 0; j < 5; ++j) sum += kWeights[i] * kWeights[j] * f(cx + hx * kNodes[i], cy + hy * kNodes[j]);
  return sum * hx * hy;
}

double refine_box(const Density2& f, const Box& b, double coarse, double tolerance, int min_depth, int max_depth) {
  const double cx = (b.x0 + b.x1) / 2, cy = (b.y0 + b.y1) / 2;
  const std::array<Box, 4> parts = {
      Box{b.x0, cx, b.y0, cy}, {cx, b.x1, b.y0, cy}, {b.x0, cx, cy, b.y1}, {cx, b.x1, cy, b.y1}};
  std::array<double, 4> values;
  double fine = 0;
  for (size_t i = 0; i < 4; ++i) fine += values[i] = gauss_box(f, parts[i]);
  if (max_depth <= 1 || !std::isfinite(fine) || (min_depth <= 1 && std::abs(fine - coarse) <= tolerance)) return fine;
  double sum = 0;
  for (size_t i = 0; i < 4; ++i) sum += refine_box(f, parts[i], values[i], tolerance / 2, min_depth - 1, max_depth - 1);
  return sum;
}

double gauss_interval(const std::function<double(double)>& f, double x0, double x1) {
  double sum = 0;
  for (size_t i = 0; i < 5; ++i) sum += kWeights[i] * f((x0 + x1) / 2 + (x1 - x0) / 2 * kNodes[i]);
  return sum * (x1 - x0) / 2;
}

double refine_interval(const std::function<double(double)>& f, double x0, double x1, double coarse, double tolerance,
                       int min_depth, int max_depth) {
  const double middle = (x0 + x1) / 2;
  const double left = gauss_interval(f, x0, middle), right = gauss_interval(f, middle, x1);
  const double fine = left + right;
  if (max_depth <= 1 || !std::isfinite(fine) || (min_depth <= 1 && std::abs(fine - coarse) <= tolerance)) return fine;
  return refine_interval(f, x0, middle, left, tolerance / 2, min_depth - 1, max_depth - 1) +
         refine_interval(f, middle, x1, right, tolerance / 2, min_depth - 1, max_depth - 1);
}

/// Observed counts and a way to integrate the density over cell i with at least so many splits.
struct Histogram {
  std::vector<double> observed;
  double failed = 0, outside = 0;
  explicit Histogram(int cells) : observed(static_cast<size_t>(cells)) {}
};

/// Integrates every cell, and again with at least `depths` splits the few cells that disagree most with the histogram:
/// a narrow peak may lie between quadrature points. More splits cannot hide a wrong density.
std::vector<double> expected_masses(const std::function<double(size_t, int)>& integrate_cell,
                                    const Histogram& histogram, int samples, std::array<int, 3> depths) {
  constexpr size_t kRefinedCells = 16;
  std::vector<double> masses(histogram.observed.size());
  for (size_t i = 0; i < masses.size(); ++i) masses[i] = integrate_cell(i, depths[0]);
  for (const int depth : {depths[1], depths[2]}) {
    std::vector<std::pair<double, size_t>> suspects;  // deviation in standard deviations, cell
    for (size_t i = 0; i < masses.size(); ++i) {
      const double expected = masses[i] * samples;
      const double deviation = std::abs(histogram.observed[i] - expected) / std::sqrt(std::max(expected, 1.0));
      if (deviation > 3.5) suspects.emplace_back(-deviation, i);
    }
    std::sort(suspects.begin(), suspects.end());
    suspects.resize(std::min(suspects.size(), kRefinedCells));
    for (const auto& [deviation, cell] : suspects) masses[cell] = integrate_cell(cell, depth);
  }
  return masses;
}

struct Cell {
  double expected, observed;
};

/// Joins cells, the smallest first, until each expects at least `least` samples.
std::vector<Cell> pool(std::vector<Cell> cells, double least) {
  std::sort(cells.begin(), cells.end(), [](const Cell& a, const Cell& b) { return a.expected < b.expected; });
  std::vector<Cell> pooled;
  Cell open{0, 0};
  for (const Cell& cell : cells) {
    open.expected += cell.expected;
    open.observed += cell.observed;
    if (open.expected < least) continue;
    pooled.push_back(open);
    open = {0, 0};
  }
  if (!pooled.empty()) {
    pooled.back().expected += open.expected;
    pooled.back().observed += open.observed;
  }
  return pooled;
}

ChiSquareResult verdict(const Histogram& histogram, const std::vector<double>& masses,
                        const ChiSquareSettings& settings) {
  ChiSquareResult result;
  std::vector<Cell> cells;
  for (size_t i = 0; i < masses.size(); ++i) {
    if (!(masses[i] >= 0)) {
      result.report = "the density is negative or not a number in cell " + std::to_string(i);
      return result;
    }
    result.mass += masses[i];
    cells.push_back({masses[i] * settings.samples, histogram.observed[i]});
  }
  const std::string facts = "; integral of the density " + std::to_string(result.mass) + ", failed samples " +
                            std::to_string(histogram.failed / settings.samples) + " of all";
  if (histogram.outside > 0) {
    result.report = std::to_string(histogram.outside) + " samples lie outside of the domain or are not finite" + facts;
    return result;
  }
  if (result.mass > 1 + kMassTolerance) {
    result.report = "the density integrates to more than 1" + facts;
    return result;
  }
  cells.push_back({std::max(0.0, 1 - result.mass) * settings.samples, histogram.failed});
  cells = pool(std::move(cells), settings.min_expected);
  if (cells.size() < 2) {
    const bool right =
        !cells.empty() && std::abs(cells[0].observed - cells[0].expected) <= 4 * std::sqrt(cells[0].expected);
    result.p_value = right ? 1 : 0;
    result.report = "all mass lies in one cell: the test says little" + facts;
    return result;
  }
  double statistic = 0;
  for (const Cell& cell : cells) statistic += sqr(cell.observed - cell.expected) / cell.expected;
  result.degrees = static_cast<int>(cells.size()) - 1;
  result.p_value = Eigen::numext::igammac(result.degrees / 2.0, statistic / 2);
  result.report = "chi-square " + std::to_string(statistic) + " for " + std::to_string(result.degrees) +
                  " degrees of freedom, p = " + std::to_string(result.p_value) + facts;
  return result;
}

/// Error that moves an expected count by far less than its own scatter.
double cell_tolerance(const ChiSquareSettings& settings) { return 0.1 / settings.samples; }

/// The index of the bin of x in n bins over [0, 1]; the upper end belongs to the last bin.
int bin_of(double x, int n) { return std::min(static_cast<int>(x * n), n - 1); }

}  // namespace

double integrate_box(const Density2& f, double x0, double x1, double y0, double y1, double tolerance, int min_depth,
                     int max_depth) {
  const Box box{x0, x1, y0, y1};
  return refine_box(f, box, gauss_box(f, box), tolerance, min_depth, max_depth);
}

double integrate_interval(const std::function<double(double)>& f, double x0, double x1, double tolerance, int min_depth,
                          int max_depth) {
  return refine_interval(f, x0, x1, gauss_interval(f, x0, x1), tolerance, min_depth, max_depth);
}

namespace {
/// Turns a density over directions into one over (theta, phi).
Density2 over_angles(const std::function<double(const Vec3&)>& f) {
  return [&f](double theta, double phi) {
    const double s = std::sin(theta);
    const Vec3 direction(static_cast<float>(s * std::cos(phi)), static_cast<float>(s * std::sin(phi)),
                         static_cast<float>(std::cos(theta)));
    return s * f(direction);
  };
}
}  // namespace

double integrate_sphere(const std::function<double(const Vec3&)>& f, double tolerance, double theta0, double theta1) {
  const Density2 density = over_angles(f);
  // Two bands, so that the horizon is an edge; four quarters of azimuth.
  const double middle = std::numbers::pi / 2;
  double sum = 0;
  for (const auto& [a, b] : {std::pair(theta0, std::min(theta1, middle)), std::pair(std::max(theta0, middle), theta1)})
    for (int quarter = 0; a < b && quarter < 4; ++quarter)
      sum += integrate_box(density, a, b, quarter * middle, (quarter + 1) * middle, tolerance / 8, 2, 11);
  return sum;
}

ChiSquareResult chi_square_sphere(const std::function<std::optional<Vec3>(Rng&)>& sample,
                                  const std::function<double(const Vec3&)>& pdf_w, const ChiSquareSettings& settings) {
  constexpr double pi = std::numbers::pi;
  const int rows = settings.theta_bins, columns = settings.phi_bins;
  Histogram histogram(rows * columns);
  Rng rng(settings.seed);
  for (int i = 0; i < settings.samples; ++i) {
    const std::optional<Vec3> v = sample(rng);
    if (!v) {
      ++histogram.failed;
      continue;
    }
    const double norm = std::sqrt(sqr(double(v->x)) + sqr(double(v->y)) + sqr(double(v->z)));
    if (!(std::abs(norm - 1) < 1e-3)) {
      ++histogram.outside;
      continue;
    }
    const double theta = std::acos(std::clamp(v->z / norm, -1.0, 1.0));
    const double phi = std::atan2(double(v->y), double(v->x));
    const int cell = bin_of(theta / pi, rows) * columns + bin_of((phi < 0 ? phi + 2 * pi : phi) / (2 * pi), columns);
    ++histogram.observed[static_cast<size_t>(cell)];
  }
  const Density2 density = over_angles(pdf_w);
  const auto cell_mass = [&](size_t i, int min_depth) {
    const int row = static_cast<int>(i) / columns, column = static_cast<int>(i) % columns;
    return integrate_box(density, row * pi / rows, (row + 1) * pi / rows, column * 2 * pi / columns,
                         (column + 1) * 2 * pi / columns, cell_tolerance(settings), min_depth);
  };
  return verdict(histogram, expected_masses(cell_mass, histogram, settings.samples, {1, 3, 5}), settings);
}

ChiSquareResult chi_square_interval(const std::function<std::optional<double>(Rng&)>& sample,
                                    const std::function<double(double)>& pdf, double low, double high,
                                    const ChiSquareSettings& settings) {
  const int bins = settings.interval_bins;
  Histogram histogram(bins);
  Rng rng(settings.seed);
  for (int i = 0; i < settings.samples; ++i) {
    const std::optional<double> x = sample(rng);
    if (!x)
      ++histogram.failed;
    else if (!(*x >= low && *x <= high))
      ++histogram.outside;
    else
      ++histogram.observed[static_cast<size_t>(bin_of((*x - low) / (high - low), bins))];
  }
  const double width = (high - low) / bins;
  const auto cell_mass = [&](size_t i, int min_depth) {
    const double x0 = low + static_cast<double>(i) * width;
    return integrate_interval(pdf, x0, x0 + width, cell_tolerance(settings), min_depth);
  };
  return verdict(histogram, expected_masses(cell_mass, histogram, settings.samples, {2, 6, 12}), settings);
}

ChiSquareResult chi_square_square(const std::function<std::optional<Vec2>(Rng&)>& sample,
                                  const std::function<double(const Vec2&)>& pdf_a, const ChiSquareSettings& settings) {
  const int rows = settings.theta_bins, columns = settings.phi_bins;
  Histogram histogram(rows * columns);
  Rng rng(settings.seed);
  for (int i = 0; i < settings.samples; ++i) {
    const std::optional<Vec2> p = sample(rng);
    if (!p) {
      ++histogram.failed;
    } else if (!(p->x >= 0 && p->x <= 1 && p->y >= 0 && p->y <= 1)) {
      ++histogram.outside;
    } else {
      const int cell = bin_of(double(p->x), rows) * columns + bin_of(double(p->y), columns);
      ++histogram.observed[static_cast<size_t>(cell)];
    }
  }
  const Density2 density = [&](double x, double y) {
    return pdf_a(Vec2(static_cast<float>(x), static_cast<float>(y)));
  };
  const auto cell_mass = [&](size_t i, int min_depth) {
    const int row = static_cast<int>(i) / columns, column = static_cast<int>(i) % columns;
    return integrate_box(density, double(row) / rows, double(row + 1) / rows, double(column) / columns,
                         double(column + 1) / columns, cell_tolerance(settings), min_depth);
  };
  return verdict(histogram, expected_masses(cell_mass, histogram, settings.samples, {1, 3, 5}), settings);
}

bool passes(const ChiSquareResult& result, int number_of_tests) {
  const double level = 1 - std::pow(1 - kSignificance, 1.0 / number_of_tests);
  return result.p_value >= level;
}

}  // namespace turbid::testing
