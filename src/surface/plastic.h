#pragma once
#include <array>

#include "surface/bsdf.h"
#include "surface/microfacet.h"

namespace turbid {

/// A diffuse base under a smooth dielectric coat, as Mitsuba 3's `plastic`: mirror reflection F, and light that enters,
/// scatters diffusely, is reflected back by the coat any number of times and leaves:
/// f = T(given) T(chosen) / eta^2 * rho / (1 - c F_d) / pi, with F_d the coat's diffuse reflectance from within and c =
/// rho
/// (`nonlinear`) or 1 (keeps the colour of the texture). Black on the inside.
class Plastic final : public Bsdf {
 public:
  /// Indices > 0 (else std::invalid_argument); diffuse_reflectance null: 0.5; factor null: 1.
  Plastic(float interior_index, float exterior_index, const TexturePtr& diffuse_reflectance,
          const TexturePtr& specular_reflectance = nullptr, bool nonlinear = false);

  lobe::Flags flags() const override { return lobe::kReflection | lobe::kDelta | lobe::kSmooth; }
  Eval eval(const SurfacePoint& point, const Vec3& given, const Vec3& chosen, TransportMode mode) const override;
  std::optional<BsdfSample> sample(const SurfacePoint& point, const Vec3& given, float u_lobe, const Vec2& u,
                                   TransportMode mode) const override;
  Spectrum albedo(const SurfacePoint& point) const override { return diffuse_.eval(point); }

 private:
  float prob_specular(float fresnel) const;

  float eta_;
  float internal_reflectance_;  ///< F_d
  bool nonlinear_;
  TextureValue diffuse_, specular_;
  float specular_share_;  ///< share of the factors' means that is specular
};

/// The same with a rough coat, as Mitsuba 3's `roughplastic`: a microfacet lobe, and T tabulated over the cosine as
/// what the rough coat does not reflect.
class RoughPlastic final : public Bsdf {
 public:
  /// As Plastic, but different indices are asked for (else std::invalid_argument); one isotropic roughness.
  RoughPlastic(float interior_index, float exterior_index, MicrofacetType type, float alpha, bool sample_visible,
               const TexturePtr& diffuse_reflectance, const TexturePtr& specular_reflectance = nullptr,
               bool nonlinear = false);

  lobe::Flags flags() const override { return lobe::kReflection | lobe::kSmooth; }
  Eval eval(const SurfacePoint& point, const Vec3& given, const Vec3& chosen, TransportMode mode) const override;
  std::optional<BsdfSample> sample(const SurfacePoint& point, const Vec3& given, float u_lobe, const Vec2& u,
                                   TransportMode mode) const override;

 private:
  static constexpr int kTableSize = 64;
  float transmittance(float cosine) const;
  float prob_specular(float transmitted) const;

  float eta_;
  float internal_reflectance_;
  bool nonlinear_;
  TextureValue diffuse_, specular_;
  float specular_share_;
  RoughnessValue roughness_;
  MicrofacetDistribution distribution_;
  std::array<float, kTableSize> transmittance_;  ///< over the cosine, uniform in [0, 1]
};

}  // namespace turbid
