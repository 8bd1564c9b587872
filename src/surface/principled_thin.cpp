#include "surface/principled_thin.h"

#include <stdexcept>

#include "core/warp.h"
#include "surface/principled_terms.h"

namespace turbid {
namespace {

Vec3 mirrored(const Vec3& v) { return {v.x, v.y, -v.z}; }

/// Mitsuba 3 lets light through a facet only where the direction towards the light sees the facet's back. That depends
/// on which of the two directions it is.
bool passes(const Vec3& given, const Vec3& chosen, const Vec3& m, TransportMode mode) {
  return dot(mode == TransportMode::kRadiance ? chosen : mirrored(given), m) < 0;
}

}  // namespace

/// What the point decides. Inside of this file directions are turned so that the given one has z > 0.
struct PrincipledThin::Local {
  float roughness, spec_trans, through;  ///< through: share of the diffuse light
  float eta;
  Spectrum color;
  MicrofacetDistribution reflecting, transmitting;
  float prob_reflect, prob_transmit, prob_diffuse;  ///< the rest goes to diffuse transmission

  float prob_diffuse_through() const { return std::max(0.0f, 1 - prob_reflect - prob_transmit - prob_diffuse); }
};

PrincipledThin::PrincipledThin(const PrincipledThinParameters& p)
    : base_color_(p.base_color, 0.5f),
      roughness_(p.roughness, 0.5f),
      anisotropic_(p.anisotropic, 0),
      spec_trans_(p.spec_trans, 0),
      eta_(p.eta, 1.5f),
      spec_tint_(p.spec_tint, 0),
      sheen_(p.sheen, 0),
      sheen_tint_(p.sheen_tint, 0),
      flatness_(p.flatness, 0),
      diff_trans_(p.diff_trans, 0),
      specular_reflectance_rate_(p.specular_reflectance_rate),
      specular_transmittance_rate_(p.specular_transmittance_rate),
      diffuse_reflectance_rate_(p.diffuse_reflectance_rate),
      diffuse_transmittance_rate_(p.diffuse_transmittance_rate),
      // The tag is the same for all settings, as in Mitsuba 3: a sheet always counts as transmitting.
      flags_(lobe::kReflection | lobe::kTransmission | lobe::kSmooth) {
  if (eta_.is_constant() && !(eta_.mean().min() > 0))
    throw std::invalid_argument("the index of refraction must be positive");
  if (!(std::min({specular_reflectance_rate_, specular_transmittance_rate_, diffuse_reflectance_rate_,
                  diffuse_transmittance_rate_}) >= 0))
    throw std::invalid_argument("sampling rates must not be negative");
}

PrincipledThin::Local PrincipledThin::local(const SurfacePoint& point) const {
  const float roughness = roughness_.eval_scalar(point), anisotropic = anisotropic_.eval_scalar(point);
  const float spec_trans = spec_trans_.eval_scalar(point), through = 0.5f * diff_trans_.eval_scalar(point);
  const float eta = eta_.eval_scalar(point);
  const float reflect = 0.5f * spec_trans * specular_reflectance_rate_;
  const float transmit = 0.5f * spec_trans * specular_transmittance_rate_;
  const float diffuse = (1 - spec_trans) * (1 - through) * diffuse_reflectance_rate_;
  const float diffuse_through = (1 - spec_trans) * through * diffuse_transmittance_rate_;
  const float total = reflect + transmit + diffuse + diffuse_through, scale = total > 0 ? 1 / total : 0;
  return {roughness, spec_trans, through, eta, base_color_.eval(point),
          principled::distribution(roughness, anisotropic),
          // Burley 2015, fig. 15: refraction into and out of the sheet blurs less the nearer the index is to 1.
          principled::distribution((0.65f * eta - 0.35f) * roughness, anisotropic), reflect * scale, transmit * scale,
          diffuse * scale};
}

Bsdf::Eval PrincipledThin::evaluate(const SurfacePoint& point, const Local& local, const Vec3& given,
                                    const Vec3& chosen, TransportMode mode) const {
  // Transmission is reflection turned to the other side.
  const bool reflected = chosen.z > 0;
  const Vec3 other = reflected ? chosen : mirrored(chosen), m = normalize(given + other);
  const float given_m = dot(given, m), cosine = other.z;
  const bool seen = given_m > 0 && (reflected || passes(given, chosen, m, mode));
  Spectrum value(0.0f);
  float pdf_w = kInvPi * cosine * (reflected ? local.prob_diffuse : local.prob_diffuse_through());
  if (local.spec_trans > 0 && seen) {
    const MicrofacetDistribution& distribution = reflected ? local.reflecting : local.transmitting;
    const float fresnel = fresnel_dielectric(std::min(given_m, 1.0f), local.eta).reflectance;
    const float dg = distribution.d(m) * distribution.g1(given, m) * distribution.g1(other, m);
    Spectrum factor = local.color * (1 - fresnel);
    if (reflected) {
      const float tinted = spec_tint_.eval_scalar(point);
      factor = Spectrum(fresnel);
      if (tinted > 0) {
        const Spectrum at_normal = principled::tint(local.color) * principled::reflectance_at_normal(local.eta);
        factor = lerp(factor, principled::schlick(at_normal, given_m, local.eta), tinted);
      }
    }
    value = factor * (local.spec_trans * dg / (4 * given.z));
    pdf_w +=
        (reflected ? local.prob_reflect : local.prob_transmit) * distribution.pdf_visible(given, m) / (4 * given_m);
  }
  const float diffuse = (1 - local.spec_trans) * cosine;
  if (!reflected) {
    value += local.color * (diffuse * local.through * kInvPi);
  } else if (diffuse > 0 && local.through < 1) {
    const float flatness = flatness_.eval_scalar(point), sheen = sheen_.eval_scalar(point);
    Spectrum base = local.color * principled::diffuse(given.z, chosen.z, given_m, local.roughness, flatness);
    if (sheen > 0) base += principled::sheen(local.color, given_m, sheen, sheen_tint_.eval_scalar(point));
    value += base * (diffuse * (1 - local.through));
  }
  return {value, pdf_w};
}

Bsdf::Eval PrincipledThin::eval(const SurfacePoint& point, const Vec3& given, const Vec3& chosen,
                                TransportMode mode) const {
  if (given.z == 0 || chosen.z == 0) return {};
  const bool turn = given.z < 0;
  return evaluate(point, local(point), turn ? mirrored(given) : given, turn ? mirrored(chosen) : chosen, mode);
}

std::optional<BsdfSample> PrincipledThin::sample(const SurfacePoint& point, const Vec3& given, float u_lobe,
                                                 const Vec2& u, TransportMode mode) const {
  if (given.z == 0) return std::nullopt;
  const Local at_point = local(point);
  const bool turn = given.z < 0;
  const Vec3 from = turn ? mirrored(given) : given;
  const float prob_specular = at_point.prob_reflect + at_point.prob_transmit;
  Vec3 to;
  bool transmitted;
  if (u_lobe < prob_specular) {
    transmitted = u_lobe >= at_point.prob_reflect;
    const Vec3 m = (transmitted ? at_point.transmitting : at_point.reflecting).sample_visible(from, u);
    to = m * (2 * dot(from, m)) - from;
    if (!(to.z > 0)) return std::nullopt;
    if (transmitted) to.z = -to.z;
    if (transmitted && !passes(from, to, m, mode)) return std::nullopt;
    to = normalize(to);
  } else {
    transmitted = u_lobe >= prob_specular + at_point.prob_diffuse;
    to = square_to_cosine_hemisphere(u);
    if (transmitted) to.z = -to.z;
  }
  if (to.z == 0) return std::nullopt;
  const Eval result = evaluate(point, at_point, from, to, mode);
  if (!(result.pdf_w > 0) || !std::isfinite(result.pdf_w)) return std::nullopt;
  return BsdfSample{turn ? mirrored(to) : to, result.value / result.pdf_w, result.pdf_w,
                    (transmitted ? lobe::kTransmission : lobe::kReflection) | lobe::kSmooth, 1};
}

}  // namespace turbid
