#include "surface/plastic.h"

#include <stdexcept>

#include "core/gauss_legendre.h"
#include "core/warp.h"
#include "surface/fresnel.h"
#include "texture/constant.h"

namespace turbid {
namespace {

float relative_index(float interior, float exterior) {
  if (!(interior > 0) || !(exterior > 0) || !std::isfinite(interior) || !std::isfinite(exterior))
    throw std::invalid_argument("indices of refraction must be positive");
  return interior / exterior;
}

float specular_share(const TextureValue& diffuse, const TextureValue& specular) {
  const float d = diffuse.mean().mean(), s = specular.mean().mean();
  return d + s > 0 ? s / (d + s) : 0.5f;
}

/// The base's radiosity after all internal reflections: rho / (1 - c F_d).
Spectrum trapped_and_released(const Spectrum& diffuse, float internal_reflectance, bool nonlinear) {
  const Spectrum kept = nonlinear ? diffuse : Spectrum(1.0f);
  return diffuse / (Spectrum(1.0f) - kept * internal_reflectance);
}

/// Part of the light of cosine mu that the facets reflect in a single bounce; eta = other side / this side.
double rough_reflectance(const MicrofacetDistribution& distribution, float mu, float eta, const GaussLegendre& rule) {
  const Vec3 v(safe_sqrt(1 - mu * mu), 0, mu);
  double sum = 0;
  for (size_t i = 0; i < rule.size(); ++i) {
    for (size_t j = 0; j < rule.size(); ++j) {
      const Vec3 m =
          distribution.sample_visible(v, Vec2(static_cast<float>(rule.node(i)), static_cast<float>(rule.node(j))));
      const float cosine = dot(v, m);
      const Vec3 reflected = m * (2 * cosine) - v;
      if (cosine <= 0 || reflected.z <= 0) continue;
      const float seen = fresnel_dielectric(cosine, eta).reflectance * distribution.g1(reflected, m);
      sum += rule.weight(i) * rule.weight(j) * double(seen);
    }
  }
  return sum;
}

}  // namespace

Plastic::Plastic(float interior_index, float exterior_index, const TexturePtr& diffuse_reflectance,
                 const TexturePtr& specular_reflectance, bool nonlinear)
    : eta_(relative_index(interior_index, exterior_index)),
      internal_reflectance_(static_cast<float>(fresnel_diffuse_reflectance(1 / double(eta_)))),
      nonlinear_(nonlinear),
      diffuse_(diffuse_reflectance, 0.5f),
      specular_(specular_reflectance, 1.0f),
      specular_share_(specular_share(diffuse_, specular_)) {}

float Plastic::prob_specular(float fresnel) const {
  const float specular = fresnel * specular_share_, diffuse = (1 - fresnel) * (1 - specular_share_);
  return specular + diffuse > 0 ? specular / (specular + diffuse) : 1;
}

Bsdf::Eval Plastic::eval(const SurfacePoint& point, const Vec3& given, const Vec3& chosen, TransportMode) const {
  if (given.z <= 0 || chosen.z <= 0) return {};
  const float f_given = fresnel_dielectric(given.z, eta_).reflectance;
  const float f_chosen = fresnel_dielectric(chosen.z, eta_).reflectance;
  const float cosine_pdf = cosine_hemisphere_pdf_w(chosen);
  const Spectrum base = trapped_and_released(diffuse_.eval(point), internal_reflectance_, nonlinear_);
  return {base * ((1 - f_given) * (1 - f_chosen) * cosine_pdf / sqr(eta_)), (1 - prob_specular(f_given)) * cosine_pdf};
}

std::optional<BsdfSample> Plastic::sample(const SurfacePoint& point, const Vec3& given, float u_lobe, const Vec2& u,
                                          TransportMode mode) const {
  if (given.z <= 0) return std::nullopt;
  const float fresnel = fresnel_dielectric(given.z, eta_).reflectance, prob = prob_specular(fresnel);
  if (u_lobe < prob)
    return BsdfSample{{-given.x, -given.y, given.z},
                      specular_.eval(point) * (fresnel / prob),
                      0,
                      lobe::kReflection | lobe::kDelta,
                      1};
  const Vec3 chosen = square_to_cosine_hemisphere(u);
  const Eval result = eval(point, given, chosen, mode);
  if (!(result.pdf_w > 0)) return std::nullopt;
  return BsdfSample{chosen, result.value / result.pdf_w, result.pdf_w, lobe::kReflection | lobe::kSmooth, 1};
}

RoughPlastic::RoughPlastic(float interior_index, float exterior_index, MicrofacetType type, float alpha,
                           bool sample_visible, const TexturePtr& diffuse_reflectance,
                           const TexturePtr& specular_reflectance, bool nonlinear)
    : eta_(relative_index(interior_index, exterior_index)),
      internal_reflectance_(0),
      nonlinear_(nonlinear),
      diffuse_(diffuse_reflectance, 0.5f),
      specular_(specular_reflectance, 1.0f),
      specular_share_(specular_share(diffuse_, specular_)),
      roughness_({type, std::make_shared<ConstantTexture>(alpha), nullptr, sample_visible}),
      distribution_(type, alpha, alpha) {
  if (eta_ == 1) throw std::invalid_argument("interior and exterior indices must differ");
  // Mitsuba 3's discretisation, so that its pictures agree: F_d is the mean over the 64 cosines, both ends counted
  // fully, which lies up to 1.5 % below the integral.
  const GaussLegendre outside(32), inside(64);
  double sum = 0;
  for (size_t i = 0; i < kTableSize; ++i) {
    const float mu = std::max(static_cast<float>(i) / (kTableSize - 1), 1e-6f);
    transmittance_[i] = static_cast<float>(1 - rough_reflectance(distribution_, mu, eta_, outside));
    sum += rough_reflectance(distribution_, mu, 1 / eta_, inside) * double(mu);
  }
  internal_reflectance_ = static_cast<float>(2 * sum / kTableSize);
}

float RoughPlastic::transmittance(float cosine) const {
  const float x = std::min(cosine, 1.0f) * (kTableSize - 1);
  const size_t i = std::min(static_cast<size_t>(x), static_cast<size_t>(kTableSize - 2));
  return std::lerp(transmittance_[i], transmittance_[i + 1], x - static_cast<float>(i));
}

float RoughPlastic::prob_specular(float transmitted) const {
  const float specular = (1 - transmitted) * specular_share_, diffuse = transmitted * (1 - specular_share_);
  return specular + diffuse > 0 ? specular / (specular + diffuse) : 1;
}

Bsdf::Eval RoughPlastic::eval(const SurfacePoint& point, const Vec3& given, const Vec3& chosen, TransportMode) const {
  if (given.z <= 0 || chosen.z <= 0) return {};
  const Vec3 m = normalize(given + chosen);
  const float given_m = dot(given, m);
  if (given_m <= 0) return {};
  const float g = distribution_.g1(given, m) * distribution_.g1(chosen, m);
  const float coat = fresnel_dielectric(given_m, eta_).reflectance * distribution_.d(m) * g / (4 * given.z);
  const float t_given = transmittance(given.z), t_chosen = transmittance(chosen.z);
  const float cosine_pdf = cosine_hemisphere_pdf_w(chosen);
  const Spectrum base = trapped_and_released(diffuse_.eval(point), internal_reflectance_, nonlinear_);
  return {specular_.eval(point) * coat + base * (t_given * t_chosen * cosine_pdf / sqr(eta_)),
          std::lerp(cosine_pdf, roughness_.pdf(distribution_, given, m) / (4 * given_m), prob_specular(t_given))};
}

std::optional<BsdfSample> RoughPlastic::sample(const SurfacePoint& point, const Vec3& given, float u_lobe,
                                               const Vec2& u, TransportMode mode) const {
  if (given.z <= 0) return std::nullopt;
  Vec3 chosen;
  if (u_lobe < prob_specular(transmittance(given.z))) {
    const Vec3 m = roughness_.sample(distribution_, given, u);
    chosen = m * (2 * dot(given, m)) - given;
  } else {
    chosen = square_to_cosine_hemisphere(u);
  }
  if (chosen.z <= 0) return std::nullopt;
  const Eval result = eval(point, given, chosen, mode);
  if (!(result.pdf_w > 0) || !std::isfinite(result.pdf_w)) return std::nullopt;
  return BsdfSample{chosen, result.value / result.pdf_w, result.pdf_w, flags(), 1};
}

}  // namespace turbid
