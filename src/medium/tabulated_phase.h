#pragma once
#include <span>
#include <vector>

#include "medium/phase_function.h"

namespace turbid {

/// Piecewise linear in mu between values at equally spaced mu from -1 (straight back) to 1 (straight on), normalised
/// here.
///
/// This is the order of Mitsuba's `tabphase`, which documents the "physics convention": its cosine is 1 for forward
/// scattering, exactly our mu, so its values are taken as they stand.
class TabulatedPhase final : public PhaseFunction {
 public:
  /// At least two non-negative finite values, not all zero (the scale does not matter); else std::invalid_argument.
  explicit TabulatedPhase(std::span<const float> values);

  float eval(float mu) const override;
  /// Exact inversion of the piecewise quadratic CDF.
  float sample(float u) const override;
  float mean_cosine() const override { return mean_cosine_; }
  std::vector<float> landmarks() const override;

 private:
  std::vector<float> density_;  ///< f at the nodes, 1/sr
  std::vector<double> cdf_;     ///< at the nodes, from 0 to 1
  float mean_cosine_ = 0;
};

}  // namespace turbid
