#include "surface/fresnel.h"

#include <algorithm>

namespace turbid {
namespace {

float conductor_reflectance(float cos_incident, float eta, float k) {
  const float cos2 = cos_incident * cos_incident, sin2 = std::max(0.0f, 1 - cos2);
  const float t0 = eta * eta - k * k - sin2;
  const float a2b2 = std::sqrt(t0 * t0 + 4 * eta * eta * k * k);
  const float a = safe_sqrt(0.5f * (a2b2 + t0));
  const float sum_s = a2b2 + cos2, cross = 2 * cos_incident * a;
  if (sum_s + cross <= 0) return 1;  // eta = k = 0 seen at grazing angle
  const float r_s = (sum_s - cross) / (sum_s + cross);
  const float sum_p = cos2 * a2b2 + sin2 * sin2, cross_p = cross * sin2;
  const float r_p = sum_p + cross_p > 0 ? r_s * (sum_p - cross_p) / (sum_p + cross_p) : r_s;
  return std::clamp(0.5f * (r_s + r_p), 0.0f, 1.0f);
}

}  // namespace

Spectrum fresnel_conductor(float cos_incident, const Spectrum& eta, const Spectrum& k) {
  Spectrum result;
  for (int c = 0; c < kChannels; ++c) result[c] = conductor_reflectance(cos_incident, eta[c], k[c]);
  return result;
}

double fresnel_diffuse_reflectance(double eta) {
  if (eta == 1) return 0;
  // Simpson's rule in t, mu = mu_c + (1 - mu_c) t^2 above the critical cosine mu_c: the square-root singularity there
  // (or at mu = 0) becomes smooth. Below mu_c everything is reflected, which contributes mu_c^2.
  const double critical = eta < 1 ? std::sqrt(1 - eta * eta) : 0;
  const auto integrand = [&](double t) {
    const double mu = critical + (1 - critical) * t * t;
    const double cos_t = std::sqrt(std::max(0.0, 1 - (1 - mu * mu) / (eta * eta)));
    const double r_s = mu + eta * cos_t > 0 ? (mu - eta * cos_t) / (mu + eta * cos_t) : 1;
    const double r_p = eta * mu + cos_t > 0 ? (eta * mu - cos_t) / (eta * mu + cos_t) : 1;
    return 0.5 * (r_s * r_s + r_p * r_p) * mu * 2 * (1 - critical) * t;
  };
  constexpr int kIntervals = 2000;
  double sum = integrand(0) + integrand(1);
  for (int i = 1; i < kIntervals; ++i) sum += (i % 2 ? 4 : 2) * integrand(double(i) / kIntervals);
  return critical * critical + 2 * sum / (3.0 * kIntervals);
}

}  // namespace turbid
