#pragma once
#include <algorithm>

#include "core/spectrum.h"
#include "core/vector.h"

namespace turbid {

/// What a smooth boundary between two dielectrics does to unpolarised light.
struct FresnelDielectric {
  float reflectance;   ///< part of the power that is reflected; 1 beyond the critical angle
  float cos_transmit;  ///< cosine of the refracted direction to the normal on its side, >= 0; 0 at total reflection
};

/// Fresnel's equations (Born & Wolf 1999, sect. 1.5.2). cos_incident in [0, 1]; eta = index on the other side / index
/// on this side, > 0. Exactly 0 for eta = 1, and 1 at grazing incidence for eta != 1.
inline FresnelDielectric fresnel_dielectric(float cos_incident, float eta) {
  const float sin2_transmit = (1 - cos_incident * cos_incident) / (eta * eta);
  if (sin2_transmit >= 1) return {eta == 1 ? 0.0f : 1.0f, 0};
  const float cos_transmit = std::sqrt(1 - sin2_transmit);
  // r_s = a/b and r_p = c/d share one division.
  const float a = cos_incident - eta * cos_transmit, b = cos_incident + eta * cos_transmit;
  const float c = eta * cos_incident - cos_transmit, d = eta * cos_incident + cos_transmit;
  const float denominator = b * d;
  return {std::min(1.0f, 0.5f * (sqr(a * d) + sqr(c * b)) / sqr(denominator)), cos_transmit};
}

/// Reflectance of a conductor for unpolarised light coming from a dielectric, per channel (Moeller 1988, "Optics";
/// Lagarde 2013 derives the form used here). eta - i k: index of the conductor relative to the dielectric. eta = 0: a
/// perfect mirror.
Spectrum fresnel_conductor(float cos_incident, const Spectrum& eta, const Spectrum& k);

/// Mean reflectance for diffuse illumination, 2 int_0^1 F(mu) mu dmu, exact by quadrature; eta as in
/// fresnel_dielectric.
double fresnel_diffuse_reflectance(double eta);

}  // namespace turbid
