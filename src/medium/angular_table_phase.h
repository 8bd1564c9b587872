#pragma once
#include <span>
#include <vector>

#include "medium/node_index.h"
#include "medium/phase_function.h"
#include "medium/refinement.h"

namespace turbid {

/// Piecewise linear in mu between values at angles that may lie as unevenly as a peak asks for, normalised here; eval()
/// and sample() agree exactly. What TabulatedPhase is for files, this is for phase functions that are computed.
///
/// The table is kept in x = (1 - mu) / 2 = sin^2(theta/2), in which floats resolve the forward direction. Backward they
/// resolve it to 5e-4 rad; nodes that coincide there are left out.
class AngularTablePhase final : public PhaseFunction {
 public:
  /// Nodes at ascending angles from 0 to pi; values non-negative and finite, not all zero, in any scale. Else
  /// std::invalid_argument.
  explicit AngularTablePhase(std::span<const Node> nodes);

  float eval(float mu) const override { return at(0.5f * (1 - mu)); }
  float eval_angle(float theta) const override;
  /// Exact inversion of the piecewise quadratic CDF.
  float sample(float u) const override;
  float mean_cosine() const override { return mean_cosine_; }
  std::vector<float> landmarks() const override;

  /// Integral of the values over the sphere, before they were normalised.
  double integral() const { return integral_; }
  size_t nodes() const { return table_.size(); }

 private:
  float at(float x) const;

  struct Entry {
    float x, density;  ///< density: f, 1/sr
    double cdf;        ///< from 0 at x = 0 to 1
  };
  std::vector<Entry> table_;
  NodeIndex x_index_, cdf_index_;  ///< to search in the table
  double integral_ = 0;
  float mean_cosine_ = 0;
};

}  // namespace turbid
