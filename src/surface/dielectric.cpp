#include "surface/dielectric.h"

#include <stdexcept>

#include "surface/fresnel.h"

namespace turbid {
namespace {

float relative_index(float interior, float exterior) {
  if (!(interior > 0) || !(exterior > 0) || !std::isfinite(interior) || !std::isfinite(exterior))
    throw std::invalid_argument("indices of refraction must be positive");
  return interior / exterior;
}

constexpr lobe::Flags kReflect = lobe::kReflection | lobe::kDelta;
constexpr lobe::Flags kRefract = lobe::kTransmission | lobe::kDelta;
constexpr lobe::Flags kPassOn = lobe::kTransmission | lobe::kDelta | lobe::kNull;

}  // namespace

Dielectric::Dielectric(float interior_index, float exterior_index, const TexturePtr& specular_reflectance,
                       const TexturePtr& specular_transmittance)
    : eta_(relative_index(interior_index, exterior_index)),
      inverse_eta_(1 / eta_),
      flags_(eta_ == 1 ? kPassOn : kReflect | kRefract),
      reflectance_(specular_reflectance, 1.0f),
      transmittance_(specular_transmittance, 1.0f) {
  plain_ = reflectance_.is_one() && transmittance_.is_one();
}

std::optional<BsdfSample> Dielectric::sample(const SurfacePoint& point, const Vec3& given, float u_lobe, const Vec2&,
                                             TransportMode mode) const {
  if (flags_ & lobe::kNull) return BsdfSample{-given, transmittance_.eval(point), 0, kPassOn, 1};
  if (given.z == 0) return std::nullopt;
  const bool outside = given.z > 0;
  const float eta = outside ? eta_ : inverse_eta_, inverse_eta = outside ? inverse_eta_ : eta_;
  const FresnelDielectric fresnel = fresnel_dielectric(std::abs(given.z), eta);
  if (u_lobe < fresnel.reflectance)
    return BsdfSample{
        {-given.x, -given.y, given.z}, plain_ ? Spectrum(1.0f) : reflectance_.eval(point), 0, kReflect, 1};
  if (fresnel.cos_transmit == 0) return std::nullopt;
  const Vec3 refracted(-inverse_eta * given.x, -inverse_eta * given.y,
                       outside ? -fresnel.cos_transmit : fresnel.cos_transmit);
  const Spectrum factor(mode == TransportMode::kRadiance ? sqr(inverse_eta) : 1.0f);
  return BsdfSample{refracted, plain_ ? factor : factor * transmittance_.eval(point), 0, kRefract, eta};
}

Spectrum Dielectric::null_transmission(const SurfacePoint& point, const Vec3&) const {
  return flags_ & lobe::kNull ? transmittance_.eval(point) : Spectrum(0.0f);
}

ThinDielectric::ThinDielectric(float interior_index, float exterior_index, const TexturePtr& specular_reflectance,
                               const TexturePtr& specular_transmittance)
    : eta_(relative_index(interior_index, exterior_index)),
      reflectance_(specular_reflectance, 1.0f),
      transmittance_(specular_transmittance, 1.0f) {}

float ThinDielectric::pane_reflectance(const Vec3& given) const {
  // R + T R T + T R^3 T + ... with T = 1 - R.
  const float r = fresnel_dielectric(std::abs(given.z), eta_).reflectance;
  return 2 * r / (1 + r);
}

std::optional<BsdfSample> ThinDielectric::sample(const SurfacePoint& point, const Vec3& given, float u_lobe,
                                                 const Vec2&, TransportMode) const {
  if (u_lobe < pane_reflectance(given))
    return BsdfSample{{-given.x, -given.y, given.z}, reflectance_.eval(point), 0, kReflect, 1};
  return BsdfSample{-given, transmittance_.eval(point), 0, kPassOn, 1};
}

Spectrum ThinDielectric::null_transmission(const SurfacePoint& point, const Vec3& given) const {
  return transmittance_.eval(point) * (1 - pane_reflectance(given));
}

}  // namespace turbid
