#include "medium/fournier_forand.h"

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

#include "core/vector.h"

namespace turbid {
namespace {

constexpr double kPiD = std::numbers::pi;
constexpr double kCore = 0x1p-24;    // sin^2(theta/2) at the rim of the innermost cone: two steps of a float mu
constexpr double kMostIndex = 1.35;  // anomalous diffraction, on which the formula rests, wants n - 1 << 1

/// delta^nu and what the formulas need of it, at L = log(delta).
struct Powers {
  double log_delta, nu;
  double one_minus_delta() const { return -std::expm1(log_delta); }
  double one_minus_power() const { return -std::expm1(nu * log_delta); }
  double inverse_power() const { return std::exp(-nu * log_delta); }
};

Powers powers(const FournierForandPhase::Parameters& p, double s2) {
  return {std::log(4 * s2 / (3 * sqr(p.n - 1))), (3 - p.slope) / 2};
}

/// (nu (1-delta) - (1-delta^nu)) / (1-delta)^2, whose terms cancel at delta = 1: numerator and root of the denominator
/// as series there.
double curvature(const Powers& p) {
  const double l = p.log_delta;
  if (std::abs(l) > 0.05) return (p.nu * p.one_minus_delta() - p.one_minus_power()) / sqr(p.one_minus_delta());
  // (delta^nu - 1 - nu (delta - 1)) / L^2 = sum over k >= 2 of (nu^k - nu) L^(k-2) / k!
  double sum = 0, power = p.nu * p.nu, factor = 0.5;
  for (int k = 2; k <= 9; ++k) {
    sum += (power - p.nu) * factor;
    power *= p.nu;
    factor *= l / (k + 1);
  }
  const double ratio = l == 0 ? 1 : std::expm1(l) / l;
  return sum / sqr(ratio);
}

/// (1-delta^nu) / (1-delta), which is nu at delta = 1.
double quotient(const Powers& p) { return p.log_delta == 0 ? p.nu : p.one_minus_power() / p.one_minus_delta(); }

/// (1-d^nu) / ((d-1) d^nu), d = delta at pi.
double backward_term(const FournierForandPhase::Parameters& parameters) {
  const Powers p = powers(parameters, 1);
  return -quotient(p) * p.inverse_power();
}

void check(const FournierForandPhase::Parameters& p) {
  if (!(p.n > 1 && p.n <= kMostIndex))
    throw std::invalid_argument(
        "the relative index of refraction of a Fournier-Forand phase function must lie in (1, " +
        std::to_string(kMostIndex) + "], " + std::to_string(p.n) + " does not");
  if (!(p.slope > 3 && p.slope < 5))
    throw std::invalid_argument("the Junge slope of a Fournier-Forand phase function must lie between 3 and 5, " +
                                std::to_string(p.slope) + " does not");
}

}  // namespace

double FournierForandPhase::density(const Parameters& parameters, double theta) {
  const double s2 = sqr(std::sin(theta / 2));
  const Powers p = powers(parameters, s2);
  // delta (1-delta^nu) - nu (1-delta) = -(1-delta) (1-delta^nu) - (nu (1-delta) - (1-delta^nu)), divided by (1-delta)^2
  const double c = curvature(p);
  return (c - (quotient(p) + c) / s2) * p.inverse_power() / (4 * kPiD) +
         backward_term(parameters) * (3 * sqr(std::cos(theta)) - 1) / (16 * kPiD);
}

double FournierForandPhase::cumulative(const Parameters& parameters, double theta) {
  const double s2 = sqr(std::sin(theta / 2));
  const Powers p = powers(parameters, s2);
  // 1-delta^(nu+1) = (1-delta) delta^nu + (1-delta^nu)
  return 1 + quotient(p) * p.inverse_power() * (1 - s2) +
         backward_term(parameters) * std::cos(theta) * sqr(std::sin(theta)) / 8;
}

FournierForandPhase::Parameters FournierForandPhase::from_backscatter(double ratio) {
  if (!(ratio >= 1e-4 && ratio <= 0.1))
    throw std::invalid_argument(
        "the backscatter ratio of a Fournier-Forand phase function must lie in [0.0001, 0.1], " +
        std::to_string(ratio) + " does not");
  const auto on_line = [](double slope) { return Parameters{1.01 + 0.1542 * (slope - 3), slope}; };
  double low = 3.01, high = 4.2;  // 4e-6 and 0.138 backward, growing in between
  for (int i = 0; i < 60; ++i) {
    const double middle = (low + high) / 2;
    (1 - cumulative(on_line(middle), kPiD / 2) < ratio ? low : high) = middle;
  }
  return on_line(low);
}

FournierForandPhase::FournierForandPhase(const Parameters& parameters) {
  check(parameters);
  const double rim = 2 * std::asin(std::sqrt(kCore));
  std::vector<double> start;
  for (double theta = rim; theta < kPiD; theta *= 1.5) start.push_back(theta);
  start.push_back(kPiD);
  const std::vector<Node> outside = refine([&](double theta) { return density(parameters, theta); },
                                           [](double theta) { return sqr(std::sin(theta / 2)); }, start);

  // The cone is a trapezoid in x with the area F(rim) / (4 pi).
  const double centre = 2 * cumulative(parameters, rim) / (4 * kPiD * kCore) - outside.front().value;
  std::vector<Node> nodes{{0, centre}};
  nodes.insert(nodes.end(), outside.begin(), outside.end());
  table_ = std::make_unique<AngularTablePhase>(nodes);
}

}  // namespace turbid
