#pragma once
#include <span>
#include <vector>

#include "medium/phase_function.h"

namespace turbid {

/// Legendre moments f_l = 2 pi int f(mu) P_l(mu) dmu for l = 0 ... last, by quadrature over the angle, normalised so
/// that f_0 is 1. Henyey-Greenstein: g^l. Scattering multiplies the band l of a distribution of directions by f_l.
std::vector<double> legendre_moments(const PhaseFunction& phase, int last);

/// Rate at which light dies away in the far field of an infinite medium, exp(-rate r)/r, per mean free path: the
/// smallest root of the transport equation's characteristic determinant, as a continued fraction over the moments.
/// Isotropic scattering: albedo atanh(rate) = rate. Between 0 and 1 for albedos in [0, 1]; at low albedo, where
/// nothing but unscattered light reaches far, it is 1.
double decay_rate(std::span<const double> moments, double albedo);

/// How many spherical harmonics the lobes of a phase function need.
struct BandLimits {
  int degree = 0;  ///< largest l
  int order = 0;   ///< largest m, the azimuth about the line from the source
  friend bool operator==(const BandLimits&, const BandLimits&) = default;
};

/// The smallest degree beyond which |f_l| stays below 0.02, or 32 if it stays below 0.035 there (Henyey-Greenstein with
/// |g| up to 0.9). Throws std::invalid_argument with advice for phase functions whose peak is narrower.
BandLimits choose_bands(const PhaseFunction& phase);

}  // namespace turbid
