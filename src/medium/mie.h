#pragma once
#include <memory>

#include "medium/angular_table_phase.h"

namespace turbid {

/// Unpolarised light scattered by homogeneous spheres, whose radii may be distributed log-normally: the series of
/// LorenzMie, summed over radii and evaluated once into a table over angles, within about 5e-4 of its value (of 1 % of
/// a neighbour's in deep minima). One phase function serves all colour channels here, so the wavelength is a parameter.
class MiePhase final : public PhaseFunction {
 public:
  struct Parameters {
    double radius = 5;           ///< median, in micrometres
    double deviation = 0.1;      ///< standard deviation of the radius's natural logarithm; 0: all alike
    double interior_ior = 1.33;  ///< of the spheres
    double interior_k = 0;       ///< their index's imaginary part, at least 0
    double exterior_ior = 1;     ///< of what is around them
    double wavelength = 550;     ///< in nanometres, in vacuum
  };
  /// Takes from milliseconds to a few seconds, growing with the size. Throws std::invalid_argument for parameters out
  /// of range; the largest spheres may have a size parameter of 2000, the median ones not less than 0.01.
  explicit MiePhase(const Parameters& parameters);

  float eval(float mu) const override { return table_->eval(mu); }
  float eval_angle(float theta) const override { return table_->eval_angle(theta); }
  float sample(float u) const override { return table_->sample(u); }
  float mean_cosine() const override { return table_->mean_cosine(); }
  std::vector<float> landmarks() const override { return table_->landmarks(); }
  const AngularTablePhase& table() const { return *table_; }

  /// Mean cosine from the coefficients of the series, without the table.
  double series_mean_cosine() const { return series_mean_cosine_; }
  /// Scattered part of the light that the spheres take out of a beam: 1 unless they absorb.
  double albedo() const { return albedo_; }

 private:
  std::unique_ptr<const AngularTablePhase> table_;
  double series_mean_cosine_ = 0, albedo_ = 0;
};

}  // namespace turbid
