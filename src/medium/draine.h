#pragma once
#include "medium/henyey_greenstein.h"

namespace turbid {

/// Draine 2003: f(mu) = HG(g; mu) (1 + alpha mu^2) / (1 + alpha (1 + 2 g^2) / 3), -1 < g < 1, alpha >= 0. It contains
/// Henyey-Greenstein (alpha = 0), Cornette & Shanks 1992 (alpha = 1) and Rayleigh scattering (g = 0, alpha = 1). g is
/// not the mean cosine.
class DrainePhase final : public PhaseFunction {
 public:
  /// Throws std::invalid_argument for parameters out of range.
  DrainePhase(float g, float alpha);

  float eval(float mu) const override { return hg_.eval(mu) * scale_ * (1 + alpha_ * mu * mu); }
  float eval_angle(float theta) const override {
    return hg_.eval_angle(theta) * scale_ * (1 + alpha_ * sqr(std::cos(theta)));
  }
  /// Inverts the CDF by Newton's method, to the precision of floats.
  float sample(float u) const override;
  float mean_cosine() const override;

 private:
  HenyeyGreensteinPhase hg_;
  float g_, alpha_, scale_;  ///< scale: 1 / (1 + alpha (1 + 2 g^2) / 3)
};

}  // namespace turbid
