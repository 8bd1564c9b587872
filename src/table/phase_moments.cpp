#include "table/phase_moments.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "core/gauss_legendre.h"
#include "table/sagittal_harmonics.h"

namespace turbid {
namespace {

/// Ends of the panels of the quadrature: even steps that resolve P_l, finer towards both ends, and the edges of f.
std::vector<double> panels(const PhaseFunction& phase, int last) {
  constexpr double kPiD = std::numbers::pi;
  std::vector<double> ends;
  const int even = 16 + 2 * last;
  for (int i = 0; i <= even; ++i) ends.push_back(kPiD * i / even);
  for (double step = kPiD / 4; step > 1e-7; step /= 2) {
    ends.push_back(step);
    ends.push_back(kPiD - step);
  }
  for (const float angle : phase.landmarks()) ends.push_back(std::clamp(static_cast<double>(angle), 0.0, kPiD));
  std::sort(ends.begin(), ends.end());
  return ends;
}

}  // namespace

std::vector<double> legendre_moments(const PhaseFunction& phase, int last) {
  const GaussLegendre rule(8);
  const std::vector<double> ends = panels(phase, last);
  std::vector<double> moments(static_cast<size_t>(last) + 1);
  for (size_t i = 0; i + 1 < ends.size(); ++i) {
    const double width = ends[i + 1] - ends[i];
    if (width <= 0) continue;
    for (size_t k = 0; k < rule.size(); ++k) {
      const double theta = ends[i] + width * rule.node(k), mu = std::cos(theta);
      const double f =
          static_cast<double>(phase.eval_angle(static_cast<float>(theta))) * std::sin(theta) * width * rule.weight(k);
      double p = 1, before = 0;
      for (int l = 0; l <= last; ++l) {
        moments[static_cast<size_t>(l)] += f * p;
        const double next = ((2 * l + 1) * mu * p - l * before) / (l + 1);
        before = p;
        p = next;
      }
    }
  }
  const double whole = moments[0];
  for (double& moment : moments) moment /= whole;
  return moments;
}

double decay_rate(std::span<const double> moments, double albedo) {
  // With h_l = (2l+1) (1 - albedo f_l): h_0 = k^2 1^2 / (h_1 - k^2 2^2 / (h_2 - ...)). The fraction grows with k from 0
  // until it reaches its first pole, so its first crossing of h_0 is found by bisection, a pole counting as beyond.
  const auto is_beyond = [&](double k) {
    double fraction = 0;
    for (size_t l = 400; l >= 1; --l) {
      const double order = static_cast<double>(l), f = l < moments.size() ? moments[l] : 0;
      const double below = (2 * order + 1) * (1 - albedo * f) - fraction;
      if (below <= 0) return true;
      fraction = k * k * order * order / below;
    }
    return fraction > 1 - albedo;
  };
  double low = 0, high = 1;
  for (int step = 0; step < 60; ++step) {
    const double middle = (low + high) / 2;
    (is_beyond(middle) ? high : low) = middle;
  }
  return low;
}

BandLimits choose_bands(const PhaseFunction& phase) {
  constexpr int kLooked = SagittalHarmonics::kMaxDegree + 32;
  const std::vector<double> moments = legendre_moments(phase, kLooked);
  int degree = kLooked;
  while (degree > 0 && std::abs(moments[static_cast<size_t>(degree)]) <= 0.02) --degree;
  if (degree > SagittalHarmonics::kMaxDegree) {
    for (int l = SagittalHarmonics::kMaxDegree + 1; l <= kLooked; ++l)
      if (const double moment = std::abs(moments[static_cast<size_t>(l)]); moment > 0.035)
        throw std::invalid_argument(fmt::format(
            "this phase function's peak is too narrow for a table of multiple scattering: its Legendre moment {} is "
            "{:.3f}, at most 0.035 can be left out (Henyey-Greenstein: |g| <= 0.9). Use the method without a table, or "
            "a medium with reduced coefficients",
            l, moment));
    degree = SagittalHarmonics::kMaxDegree;
  }
  return {degree, std::min(degree, (degree + 9) / 6)};
}

}  // namespace turbid
