#pragma once
#include <cmath>
#include <numbers>
#include <vector>

namespace turbid {

/// Gauss-Legendre quadrature on [0, 1]: n points integrate polynomials up to degree 2n - 1 exactly.
class GaussLegendre {
 public:
  /// Newton's method on the Legendre polynomial P_n, from Tricomi's guesses of its roots (Abramowitz & Stegun 22.16.6).
  explicit GaussLegendre(size_t n) : nodes_(n), weights_(n) {
    const auto degree = static_cast<double>(n);
    for (size_t i = 0; i < n; ++i) {
      double x = std::cos(std::numbers::pi * (static_cast<double>(i) + 0.75) / (degree + 0.5)), slope = 1;
      for (int step = 0; step < 100; ++step) {
        double p = 1, previous = 0;
        for (size_t k = 1; k <= n; ++k) {
          const auto order = static_cast<double>(k);
          const double next = ((2 * order - 1) * x * p - (order - 1) * previous) / order;
          previous = p;
          p = next;
        }
        slope = degree * (x * p - previous) / (x * x - 1);
        const double change = p / slope;
        x -= change;
        if (std::abs(change) < 1e-15) break;
      }
      nodes_[i] = (1 - x) / 2;
      weights_[i] = 1 / ((1 - x * x) * slope * slope);
    }
  }

  size_t size() const { return nodes_.size(); }
  double node(size_t i) const { return nodes_[i]; }
  double weight(size_t i) const { return weights_[i]; }

 private:
  std::vector<double> nodes_, weights_;
};

}  // namespace turbid
