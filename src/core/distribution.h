#pragma once
#include <cstddef>
#include <span>
#include <vector>

#include "core/vector.h"

namespace turbid {

/// A draw from a DiscreteDistribution: the index, its probability, and u rescaled to [0,1) for reuse.
struct DiscreteSample {
  size_t index;
  float prob;
  float u;
};

/// Chooses one of n indices with probability proportional to non-negative weights. All weights zero: `sum()` is 0, and
/// sampling is not allowed. Negative or non-finite weights throw std::invalid_argument.
class DiscreteDistribution {
 public:
  DiscreteDistribution() = default;
  explicit DiscreteDistribution(std::span<const float> weights);

  size_t size() const { return cdf_.empty() ? 0 : cdf_.size() - 1; }
  double sum() const { return sum_; }
  float prob(size_t index) const { return static_cast<float>(cdf_[index + 1] - cdf_[index]); }
  /// One number u in [0,1).
  DiscreteSample sample(float u) const;

 private:
  std::vector<double> cdf_;
  double sum_ = 0;
};

/// Piecewise constant density over [0,1)^2 on a grid of nx x ny cells, row by row (x fastest).
class Distribution2D {
 public:
  Distribution2D() = default;
  Distribution2D(std::span<const float> weights, size_t nx, size_t ny);

  struct Sample {
    Vec2 p;
    float pdf_a;  ///< per unit area of the square
  };
  Sample sample(const Vec2& u) const;
  float pdf_a(const Vec2& p) const;
  double sum() const { return marginal_.sum(); }

 private:
  std::vector<DiscreteDistribution> rows_;
  DiscreteDistribution marginal_;
  size_t nx_ = 0, ny_ = 0;
};

}  // namespace turbid
