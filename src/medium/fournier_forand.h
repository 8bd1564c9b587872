#pragma once
#include <memory>

#include "medium/angular_table_phase.h"

namespace turbid {

/// Particles in natural water: spheres of a real index of refraction n (relative to the water) whose radii follow a
/// Junge distribution, numbers ~ r^-slope (Fournier & Forand 1994, in the form of Fournier & Jonasz 1999). With
/// s = sin(theta/2), delta = 4 s^2 / (3 (n - 1)^2), nu = (3 - slope) / 2 and d = delta at theta = pi,
///
///   f = ( nu (1-delta) - (1-delta^nu) + (delta (1-delta^nu) - nu (1-delta)) / s^2 ) / (4 pi (1-delta)^2 delta^nu)
///     + (1-d^nu) (3 cos^2 theta - 1) / (16 pi (d-1) d^nu),
///
/// whose integral F over the cone of half-angle theta is known too, and F(pi) = 1.
///
/// At theta = 0 stands a pole, ~ theta^(slope-5), which can be integrated: for slopes near 3 half of the light stays
/// within a milliradian. A float mu next to 1 cannot resolve it, nor do waters of the real world have it (what bends
/// light so little there is turbulence). So in the innermost cone of 0.5 mrad f is linear in mu, continuous, and
/// carries what F says. Evaluated from a table that meets the formula within 3e-4, and sampled exactly.
class FournierForandPhase final : public PhaseFunction {
 public:
  struct Parameters {
    double n;      ///< index of refraction relative to the water, above 1, at most 1.35
    double slope;  ///< of the distribution of radii, between 3 and 5; natural waters: 3.1 to 4.1
  };
  /// Throws std::invalid_argument for parameters out of range; within, the formula is positive everywhere.
  explicit FournierForandPhase(const Parameters& parameters);

  /// The pair on the line n = 1.01 + 0.1542 (slope - 3), along which Mobley et al. 2002 order natural particles, that
  /// scatters this part of the light backward. From 0.0001 (large algae) to 0.1 (fine minerals), else
  /// std::invalid_argument.
  static Parameters from_backscatter(double ratio);

  float eval(float mu) const override { return table_->eval(mu); }
  float eval_angle(float theta) const override { return table_->eval_angle(theta); }
  float sample(float u) const override { return table_->sample(u); }
  float mean_cosine() const override { return table_->mean_cosine(); }
  std::vector<float> landmarks() const override { return table_->landmarks(); }
  const AngularTablePhase& table() const { return *table_; }

  /// The formula for f, 1/sr, theta > 0.
  static double density(const Parameters& parameters, double theta);
  /// The formula for F, theta > 0: the part of the light that is deflected by at most theta.
  static double cumulative(const Parameters& parameters, double theta);

 private:
  std::unique_ptr<const AngularTablePhase> table_;
};

}  // namespace turbid
