#include "surface/conductor.h"

#include "core/gauss_legendre.h"
#include "surface/fresnel.h"

namespace turbid {
namespace {

/// 2 int F(mu) mu dmu.
Spectrum mean_fresnel(const Spectrum& eta, const Spectrum& k) {
  static const GaussLegendre rule(8);
  Spectrum sum;
  for (size_t i = 0; i < rule.size(); ++i) {
    const auto mu = static_cast<float>(rule.node(i));
    sum += fresnel_conductor(mu, eta, k) * (2 * mu * static_cast<float>(rule.weight(i)));
  }
  return sum;
}

}  // namespace

std::optional<BsdfSample> Conductor::sample(const SurfacePoint& point, const Vec3& given, float, const Vec2&,
                                            TransportMode) const {
  if (given.z <= 0) return std::nullopt;
  const Spectrum fresnel = fresnel_conductor(given.z, eta_.eval(point), k_.eval(point));
  return BsdfSample{{-given.x, -given.y, given.z}, fresnel * reflectance_.eval(point), 0, flags(), 1};
}

RoughConductor::RoughConductor(const TexturePtr& eta, const TexturePtr& k, const Roughness& roughness,
                               const TexturePtr& specular_reflectance, bool energy_compensation)
    : eta_(eta, 0.0f), k_(k, 1.0f), reflectance_(specular_reflectance, 1.0f), roughness_(roughness) {
  if (energy_compensation) compensation_ = EnergyCompensation(roughness_, 0);
}

Bsdf::Eval RoughConductor::evaluate(const SurfacePoint& point, const MicrofacetDistribution& distribution,
                                    const Vec3& given, const Vec3& chosen, const Vec3& m) const {
  const float given_m = dot(given, m);
  if (given_m <= 0) return {};
  const Spectrum eta = eta_.eval(point), k = k_.eval(point), colour = reflectance_.eval(point);
  const float g = distribution.g1(given, m) * distribution.g1(chosen, m);
  Eval result{fresnel_conductor(given_m, eta, k) * colour * (distribution.d(m) * g / (4 * given.z)),
              roughness_.pdf(distribution, given, m) / (4 * given_m)};
  if (!compensation_.is_on()) return result;
  const EnergyCompensation::Lobe lost = compensation_.at(roughness_.mean_alpha(point), given);
  if (!(lost.missing > 0)) return result;
  // What is lost bounces on: a part 1 - e leaves after each bounce with factor F (Kulla & Conty 2017).
  const Spectrum mean = mean_fresnel(eta, k) * colour;
  const float missing = 1 / lost.inverse_mean[0];
  const Spectrum factor = mean * mean * (1 - missing) / (Spectrum(1.0f) - mean * missing);
  result.value += factor * lost.value(chosen);
  result.pdf_w = std::lerp(result.pdf_w, lost.pdf_w(chosen), lost.missing);
  return result;
}

Bsdf::Eval RoughConductor::eval(const SurfacePoint& point, const Vec3& given, const Vec3& chosen, TransportMode) const {
  if (given.z <= 0 || chosen.z <= 0) return {};
  return evaluate(point, roughness_.at(point), given, chosen, normalize(given + chosen));
}

std::optional<BsdfSample> RoughConductor::sample(const SurfacePoint& point, const Vec3& given, float u_lobe,
                                                 const Vec2& u, TransportMode mode) const {
  if (given.z <= 0) return std::nullopt;
  const EnergyCompensation::Lobe lost =
      compensation_.is_on() ? compensation_.at(roughness_.mean_alpha(point), given) : EnergyCompensation::Lobe{};
  Vec3 chosen;
  Eval result;
  if (u_lobe < lost.missing) {
    chosen = lost.sample(0, u);
    result = eval(point, given, chosen, mode);
  } else {
    const MicrofacetDistribution distribution = roughness_.at(point);
    const Vec3 m = roughness_.sample(distribution, given, u);
    chosen = m * (2 * dot(given, m)) - given;
    if (chosen.z <= 0) return std::nullopt;
    result = evaluate(point, distribution, given, chosen, m);
  }
  if (!(result.pdf_w > 0) || !std::isfinite(result.pdf_w)) return std::nullopt;
  return BsdfSample{chosen, result.value / result.pdf_w, result.pdf_w, flags(), 1};
}

}  // namespace turbid
