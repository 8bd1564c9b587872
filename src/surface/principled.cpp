#include "surface/principled.h"

#include <stdexcept>

#include "core/warp.h"
#include "surface/principled_terms.h"

namespace turbid {
namespace {

Vec3 mirrored(const Vec3& v) { return {v.x, v.y, -v.z}; }

/// The coat's facets: generalised Trowbridge-Reitz with exponent 1 (Burley 2012, appendix B), isotropic.
struct Gtr1 {
  float alpha2;

  explicit Gtr1(float gloss) : alpha2(sqr(std::lerp(0.1f, 0.001f, std::clamp(gloss, 0.0f, 1.0f)))) {}
  float d(const Vec3& m) const { return (alpha2 - 1) / (kPi * std::log(alpha2) * (1 + (alpha2 - 1) * sqr(m.z))); }
  /// A facet normal with density d(m) cos(m).
  Vec3 sample(const Vec2& u) const {
    const float z2 = (1 - std::pow(alpha2, 1 - u.y)) / (1 - alpha2), r = safe_sqrt(1 - z2), phi = 2 * kPi * u.x;
    return {r * std::cos(phi), r * std::sin(phi), safe_sqrt(z2)};
  }
};

/// Masking of the coat: GGX of a fixed roughness, whatever the gloss.
const MicrofacetDistribution& coat_masking() {
  static const MicrofacetDistribution distribution(MicrofacetType::kGgx, 0.25f, 0.25f);
  return distribution;
}

bool is_black(const TextureValue& value) { return value.is_constant() && value.mean().is_black(); }

}  // namespace

/// What the point and the side of the given direction decide.
struct Principled::Local {
  MicrofacetDistribution distribution;
  bool outside;  ///< the given direction is
  float eta;     ///< other side / given side
  float roughness, metallic;
  float base, refracting;  ///< weights of the diffuse base and of refraction
  float clearcoat, gloss;
  Spectrum color;
  float prob_diffuse, prob_clearcoat;  ///< the rest goes to the main lobes

  /// Of the main lobes' samples, the share that is reflected.
  float prob_reflect(float fresnel) const { return outside ? 1 - refracting * (1 - fresnel) : fresnel; }
};

float Principled::eta_of_specular(float specular) { return 2 / (1 - std::sqrt(0.08f * specular)) - 1; }

Principled::Principled(const PrincipledParameters& p)
    : base_color_(p.base_color, 0.5f),
      roughness_(p.roughness, 0.5f),
      anisotropic_(p.anisotropic, 0),
      metallic_(p.metallic, 0),
      spec_trans_(p.spec_trans, 0),
      spec_tint_(p.spec_tint, 0),
      sheen_(p.sheen, 0),
      sheen_tint_(p.sheen_tint, 0),
      flatness_(p.flatness, 0),
      clearcoat_(p.clearcoat, 0),
      clearcoat_gloss_(p.clearcoat_gloss, 0),
      eta_(p.eta),
      diffuse_rate_(p.diffuse_rate),
      specular_rate_(p.specular_rate),
      clearcoat_rate_(p.clearcoat_rate),
      flags_(lobe::kReflection | lobe::kSmooth) {
  if (!(eta_ > 0) || !std::isfinite(eta_)) throw std::invalid_argument("the index of refraction must be positive");
  if (!(std::min({diffuse_rate_, specular_rate_, clearcoat_rate_}) >= 0))
    throw std::invalid_argument("sampling rates must not be negative");
  if (is_black(spec_trans_)) return;
  flags_ |= lobe::kTransmission;
  constexpr float kNearlyEqual = 1.001f;  // equal indices leave half vectors undefined; Mitsuba 3's way out
  if (eta_ == 1) eta_ = kNearlyEqual;
}

Principled::Local Principled::local(const SurfacePoint& point, const Vec3& given) const {
  const bool outside = given.z > 0;
  const float roughness = roughness_.eval_scalar(point), metallic = metallic_.eval_scalar(point);
  const float spec_trans = spec_trans_.eval_scalar(point), clearcoat = clearcoat_.eval_scalar(point);
  const float base = (1 - metallic) * (1 - spec_trans), refracting = (1 - metallic) * spec_trans;
  Local result{principled::distribution(roughness, anisotropic_.eval_scalar(point)),
               outside,
               outside ? eta_ : 1 / eta_,
               roughness,
               metallic,
               base,
               refracting,
               clearcoat,
               clearcoat_gloss_.eval_scalar(point),
               base_color_.eval(point),
               0,
               0};
  if (outside) {
    const float diffuse = base * diffuse_rate_, coat = 0.25f * clearcoat * clearcoat_rate_;
    const float total = specular_rate_ + diffuse + coat;
    result.prob_diffuse = total > 0 ? diffuse / total : 0;
    result.prob_clearcoat = total > 0 ? coat / total : 0;
  }
  return result;
}

/// Reflection on the outside: value |cos(chosen)|; `fresnel` is the dielectric's.
Spectrum Principled::reflected(const SurfacePoint& point, const Local& local, const Vec3& given, const Vec3& chosen,
                               const Vec3& m, float fresnel) const {
  const float cos_d = dot(given, m);
  Spectrum value(0.0f);
  if (fresnel > 0) {
    const float tinted = spec_tint_.eval_scalar(point);
    Spectrum f((1 - local.metallic) * (1 - tinted) * fresnel);
    if (local.metallic > 0) f += principled::schlick(local.color, cos_d, local.eta) * local.metallic;
    if (tinted > 0) {
      const Spectrum at_normal = principled::tint(local.color) * principled::reflectance_at_normal(local.eta);
      f += principled::schlick(at_normal, cos_d, local.eta) * ((1 - local.metallic) * tinted);
    }
    const MicrofacetDistribution& distribution = local.distribution;
    value = f * (distribution.d(m) * distribution.g1(given, m) * distribution.g1(chosen, m) / (4 * given.z));
  }
  if (local.clearcoat > 0) {
    const float g = coat_masking().g1(given, m) * coat_masking().g1(chosen, m);
    const Spectrum f = principled::schlick(Spectrum(0.04f), cos_d, local.eta);
    value += f * (0.25f * local.clearcoat * Gtr1(local.gloss).d(m) * g * chosen.z);
  }
  if (local.base > 0) {
    const float flatness = flatness_.eval_scalar(point), sheen = sheen_.eval_scalar(point);
    const float diffuse = principled::diffuse(given.z, chosen.z, cos_d, local.roughness, flatness);
    value += local.color * (local.base * diffuse * chosen.z);
    if (sheen > 0)
      value += principled::sheen(local.color, cos_d, sheen * (1 - local.metallic), sheen_tint_.eval_scalar(point)) *
               chosen.z;
  }
  return value;
}

Bsdf::Eval Principled::evaluate(const SurfacePoint& point, const Local& local, const Vec3& given, const Vec3& chosen,
                                const Vec3& m, TransportMode mode) const {
  const float given_m = dot(given, m), chosen_m = dot(chosen, m);
  const float prob_main = 1 - local.prob_diffuse - local.prob_clearcoat;
  // A half vector of two directions on one side always sees both; of two sides it may not.
  if (!(given_m > 0)) return {};
  const float fresnel = fresnel_dielectric(std::min(given_m, 1.0f), local.eta).reflectance;
  const float prob_reflect = local.prob_reflect(fresnel), pdf_m = local.distribution.pdf_visible(given, m);
  if (chosen.z > 0) {
    float pdf_w =
        prob_main * prob_reflect * pdf_m / (4 * given_m) + local.prob_diffuse * cosine_hemisphere_pdf_w(chosen);
    if (local.prob_clearcoat > 0) pdf_w += local.prob_clearcoat * Gtr1(local.gloss).d(m) * m.z / (4 * given_m);
    if (local.outside) return {reflected(point, local, given, chosen, m, fresnel), pdf_w};
    const MicrofacetDistribution& d = local.distribution;
    const float value = local.refracting * fresnel * d.d(m) * d.g1(given, m) * d.g1(chosen, m) / (4 * given.z);
    return {Spectrum(value), pdf_w};
  }
  const float denominator = sqr(given_m + local.eta * chosen_m);
  if (!(chosen_m < 0) || !(denominator > 0)) return {};
  const float jacobian = sqr(local.eta) * -chosen_m / denominator;
  const float g = local.distribution.g1(given, m) * local.distribution.g1(chosen, m);
  const float value = local.refracting * (1 - fresnel) * local.distribution.d(m) * g * given_m * jacobian / given.z;
  const float scale = mode == TransportMode::kRadiance ? 1 / sqr(local.eta) : 1.0f;
  return {sqrt(local.color) * (value * scale), prob_main * (1 - prob_reflect) * pdf_m * jacobian};
}

Bsdf::Eval Principled::eval(const SurfacePoint& point, const Vec3& given, const Vec3& chosen,
                            TransportMode mode) const {
  if (given.z == 0 || chosen.z == 0) return {};
  const Local at_point = local(point, given);
  if (!at_point.outside && !(at_point.refracting > 0)) return {};
  const Vec3 from = at_point.outside ? given : mirrored(given), to = at_point.outside ? chosen : mirrored(chosen);
  if (to.z < 0 && !(at_point.refracting > 0)) return {};
  Vec3 m = normalize(to.z > 0 ? from + to : from + to * at_point.eta);
  if (m.z < 0) m = -m;
  return evaluate(point, at_point, from, to, m, mode);
}

std::optional<BsdfSample> Principled::sample(const SurfacePoint& point, const Vec3& given, float u_lobe, const Vec2& u,
                                             TransportMode mode) const {
  if (given.z == 0) return std::nullopt;
  const Local at_point = local(point, given);
  if (!at_point.outside && !(at_point.refracting > 0)) return std::nullopt;
  const Vec3 from = at_point.outside ? given : mirrored(given);
  const float prob_others = at_point.prob_diffuse + at_point.prob_clearcoat;
  Vec3 m, to;
  bool transmitted = false;
  if (u_lobe < at_point.prob_diffuse) {
    to = square_to_cosine_hemisphere(u);
    m = normalize(from + to);
  } else if (u_lobe < prob_others) {
    m = Gtr1(at_point.gloss).sample(u);
    to = m * (2 * dot(from, m)) - from;
  } else {
    m = at_point.distribution.sample_visible(from, u);
    const float from_m = std::min(dot(from, m), 1.0f);
    const FresnelDielectric fresnel = fresnel_dielectric(std::max(from_m, 0.0f), at_point.eta);
    transmitted = u_lobe - prob_others >= (1 - prob_others) * at_point.prob_reflect(fresnel.reflectance);
    to = transmitted ? m * (from_m / at_point.eta - fresnel.cos_transmit) - from / at_point.eta
                     : m * (2 * from_m) - from;
  }
  if (!(dot(from, m) > 0) || !(transmitted ? to.z < 0 : to.z > 0)) return std::nullopt;
  to = normalize(to);
  const Eval result = evaluate(point, at_point, from, to, m, mode);
  if (!(result.pdf_w > 0) || !std::isfinite(result.pdf_w)) return std::nullopt;
  return BsdfSample{at_point.outside ? to : mirrored(to), result.value / result.pdf_w, result.pdf_w,
                    (transmitted ? lobe::kTransmission : lobe::kReflection) | lobe::kSmooth,
                    transmitted ? at_point.eta : 1};
}

}  // namespace turbid
