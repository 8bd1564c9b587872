#include "surface/rough_dielectric.h"

#include <stdexcept>

#include "surface/fresnel.h"

namespace turbid {
namespace {

constexpr lobe::Flags kPassOn = lobe::kTransmission | lobe::kDelta | lobe::kNull;

Vec3 mirrored(const Vec3& v) { return {v.x, v.y, -v.z}; }

/// Puts u back into [0, 1) after a choice with probability p that u < p decided.
float rescaled_below(float u, float p) { return std::min(u / p, 0x1.fffffep-1f); }
float rescaled_above(float u, float p) { return std::min((u - p) / (1 - p), 0x1.fffffep-1f); }

}  // namespace

/// What depends on the point and the given direction alone. Inside of this file directions are turned so that the given
/// one has z > 0; the surface looks the same from both sides but for the index.
struct RoughDielectric::Lobes {
  MicrofacetDistribution distribution;
  bool outside;  ///< the given direction is
  float eta;     ///< other side / given side
  EnergyCompensation::Lobe lost;
};

RoughDielectric::RoughDielectric(float interior_index, float exterior_index, const Roughness& roughness,
                                 const TexturePtr& specular_reflectance, const TexturePtr& specular_transmittance,
                                 bool energy_compensation)
    : eta_(interior_index / exterior_index),
      roughness_(roughness),
      reflectance_(specular_reflectance, 1.0f),
      transmittance_(specular_transmittance, 1.0f) {
  if (!(interior_index > 0) || !(exterior_index > 0) || !std::isfinite(interior_index) ||
      !std::isfinite(exterior_index))
    throw std::invalid_argument("indices of refraction must be positive");
  if (energy_compensation && eta_ != 1) compensation_ = EnergyCompensation(roughness_, eta_);
}

lobe::Flags RoughDielectric::flags() const {
  return eta_ == 1 ? kPassOn : lobe::kReflection | lobe::kTransmission | lobe::kSmooth;
}

Spectrum RoughDielectric::null_transmission(const SurfacePoint& point, const Vec3&) const {
  return eta_ == 1 ? transmittance_.eval(point) : Spectrum(0.0f);
}

RoughDielectric::Lobes RoughDielectric::lobes(const SurfacePoint& point, const Vec3& given) const {
  const bool outside = given.z > 0;
  Lobes result{roughness_.at(point), outside, outside ? eta_ : 1 / eta_, {}};
  if (compensation_.is_on()) result.lost = compensation_.at(roughness_.mean_alpha(point), given);
  return result;
}

Bsdf::Eval RoughDielectric::evaluate(const SurfacePoint& point, const Lobes& lobes, const Vec3& given,
                                     const Vec3& chosen, const Vec3& m, TransportMode mode) const {
  const bool reflected = chosen.z > 0;
  const float given_m = dot(given, m), chosen_m = dot(chosen, m);
  float value = 0, pdf_w = 0;
  // The facet must show the same face as the surface does, to both directions.
  if (given_m > 0 && (reflected ? chosen_m > 0 : chosen_m < 0)) {
    const MicrofacetDistribution& distribution = lobes.distribution;
    const float d = distribution.d(m), g = distribution.g1(given, m) * distribution.g1(chosen, m);
    const float pdf_m = roughness_.pdf(distribution, given, m);
    const float fresnel = fresnel_dielectric(given_m, lobes.eta).reflectance;
    // Walter et al. 2007, eq. 13-14, 17, 20-21.
    if (reflected) {
      value = fresnel * d * g / (4 * given.z);
      pdf_w = fresnel * pdf_m / (4 * given_m);
    } else {
      const float denominator = sqr(given_m + lobes.eta * chosen_m);
      if (denominator > 0) {
        const float jacobian = sqr(lobes.eta) * -chosen_m / denominator;
        value = (1 - fresnel) * d * g * given_m * jacobian / given.z;
        pdf_w = (1 - fresnel) * pdf_m * jacobian;
      }
    }
  }
  if (lobes.lost.missing > 0) {
    const Vec3 direction = lobes.outside ? chosen : mirrored(chosen);
    value += lobes.lost.value(direction);
    pdf_w = std::lerp(pdf_w, lobes.lost.pdf_w(direction), lobes.lost.missing);
  }
  if (reflected) return {reflectance_.eval(point) * value, pdf_w};
  const float scale = mode == TransportMode::kRadiance ? 1 / sqr(lobes.eta) : 1.0f;
  return {transmittance_.eval(point) * (value * scale), pdf_w};
}

Bsdf::Eval RoughDielectric::eval(const SurfacePoint& point, const Vec3& given, const Vec3& chosen,
                                 TransportMode mode) const {
  if (eta_ == 1 || given.z == 0 || chosen.z == 0) return {};
  const Lobes at_point = lobes(point, given);
  const Vec3 g = at_point.outside ? given : mirrored(given), c = at_point.outside ? chosen : mirrored(chosen);
  Vec3 m = c.z > 0 ? g + c : g + c * at_point.eta;
  const float norm2 = length_squared(m);
  if (norm2 == 0) return {};
  m *= (m.z < 0 ? -1.0f : 1.0f) / std::sqrt(norm2);
  return evaluate(point, at_point, g, c, m, mode);
}

std::optional<BsdfSample> RoughDielectric::sample(const SurfacePoint& point, const Vec3& given, float u_lobe,
                                                  const Vec2& u, TransportMode mode) const {
  if (eta_ == 1) return BsdfSample{-given, transmittance_.eval(point), 0, kPassOn, 1};
  if (given.z == 0) return std::nullopt;
  const Lobes at_point = lobes(point, given);
  const Vec3 g = at_point.outside ? given : mirrored(given);
  const float eta = at_point.eta;

  Vec3 c;
  Eval result;
  if (u_lobe < at_point.lost.missing) {
    const Vec3 chosen = at_point.lost.sample(rescaled_below(u_lobe, at_point.lost.missing), u);
    c = at_point.outside ? chosen : mirrored(chosen);
    result = eval(point, given, chosen, mode);
  } else {
    const Vec3 m = roughness_.sample(at_point.distribution, g, u);
    const float cosine = dot(g, m);
    if (cosine <= 0) return std::nullopt;
    const FresnelDielectric fresnel = fresnel_dielectric(cosine, eta);
    const bool reflect = rescaled_above(u_lobe, at_point.lost.missing) < fresnel.reflectance;
    c = reflect ? m * (2 * cosine) - g : m * (cosine / eta - fresnel.cos_transmit) - g * (1 / eta);
    if (reflect ? c.z <= 0 : c.z >= 0) return std::nullopt;
    result = evaluate(point, at_point, g, c, m, mode);
  }
  if (!(result.pdf_w > 0) || !std::isfinite(result.pdf_w)) return std::nullopt;
  const bool reflected = c.z > 0;
  return BsdfSample{at_point.outside ? c : mirrored(c), result.value / result.pdf_w, result.pdf_w,
                    (reflected ? lobe::kReflection : lobe::kTransmission) | lobe::kSmooth, reflected ? 1.0f : eta};
}

}  // namespace turbid
