#pragma once
#include <algorithm>

#include "surface/fresnel.h"
#include "surface/microfacet.h"

/// Terms that the two principled materials share (Burley 2012, Burley 2015). Directions are turned to the side of the
/// given one.
namespace turbid::principled {

/// Schlick's weight of grazing angles, (1 - cos)^5.
inline float schlick_weight(float cosine) {
  const float m = std::clamp(1 - cosine, 0.0f, 1.0f);
  return sqr(sqr(m)) * m;
}

/// Schlick's approximation of Fresnel reflectance from its value at normal incidence; with the cosine on the thinner
/// side (eta = other / this side).
inline Spectrum schlick(const Spectrum& at_normal, float cosine, float eta) {
  const float thin_cosine = eta > 1 ? cosine : safe_sqrt(1 - (1 - sqr(cosine)) / sqr(eta));
  return lerp(at_normal, Spectrum(1.0f), schlick_weight(thin_cosine));
}

inline float reflectance_at_normal(float eta) { return sqr((eta - 1) / (eta + 1)); }

/// The colour alone: of luminance 1; white for black.
inline Spectrum tint(const Spectrum& color) {
  const float luminance = color.luminance();
  return luminance > 0 ? color / luminance : Spectrum(1.0f);
}

/// GGX of the perceptual roughness: alpha = roughness^2, drawn out along u by `anisotropic` in [0, 1].
inline MicrofacetDistribution distribution(float roughness, float anisotropic) {
  constexpr float kSmallest = 1e-3f;
  const float alpha = sqr(roughness), aspect = safe_sqrt(1 - 0.9f * anisotropic);
  return {MicrofacetType::kGgx, std::max(kSmallest, alpha / aspect), std::max(kSmallest, alpha * aspect)};
}

/// The diffuse base without its colour and cosine: Lambert with Fresnel shadows, retro-reflection, and, by `flatness`,
/// a stand-in for subsurface scattering (after Hanrahan & Krueger 1993). cos_d: of either direction to the half vector.
inline float diffuse(float cos_given, float cos_chosen, float cos_d, float roughness, float flatness) {
  const float fi = schlick_weight(cos_given), fo = schlick_weight(cos_chosen);
  const float rr = 2 * roughness * sqr(cos_d);
  const float base = (1 - 0.5f * fi) * (1 - 0.5f * fo) + rr * (fo + fi + fo * fi * (rr - 1));
  if (flatness == 0) return kInvPi * base;
  const float fss90 = rr / 2;
  const float fss = std::lerp(1.0f, fss90, fo) * std::lerp(1.0f, fss90, fi);
  const float subsurface = 1.25f * (fss * (1 / (cos_given + cos_chosen) - 0.5f) + 0.5f);
  return kInvPi * std::lerp(base, subsurface, flatness);
}

/// Light at grazing angles from fibres, without its cosine.
inline Spectrum sheen(const Spectrum& color, float cos_d, float amount, float tinted) {
  return lerp(Spectrum(1.0f), tint(color), tinted) * (amount * schlick_weight(cos_d));
}

}  // namespace turbid::principled
