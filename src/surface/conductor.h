#pragma once
#include "surface/bsdf.h"
#include "surface/energy_compensation.h"
#include "surface/microfacet.h"

namespace turbid {

/// A smooth metal: mirror reflection with complex Fresnel factors; black on the inside.
class Conductor final : public Bsdf {
 public:
  /// eta null: 0, k null: 1 (together a perfect mirror); factor null: 1.
  Conductor(const TexturePtr& eta, const TexturePtr& k, const TexturePtr& specular_reflectance = nullptr)
      : eta_(eta, 0.0f), k_(k, 1.0f), reflectance_(specular_reflectance, 1.0f) {}

  lobe::Flags flags() const override { return lobe::kReflection | lobe::kDelta; }
  Eval eval(const SurfacePoint&, const Vec3&, const Vec3&, TransportMode) const override { return {}; }
  std::optional<BsdfSample> sample(const SurfacePoint& point, const Vec3& given, float u_lobe, const Vec2& u,
                                   TransportMode mode) const override;
  Spectrum albedo(const SurfacePoint&) const override { return Spectrum(0.0f); }

 private:
  TextureValue eta_, k_, reflectance_;
};

/// A rough metal: microfacets that reflect (Cook & Torrance; Walter et al. 2007), single scattering, separable Smith
/// masking, as Mitsuba 3's `roughconductor`; black on the inside. `energy_compensation` adds what several bounces
/// between facets would bring (Kulla & Conty 2017).
class RoughConductor final : public Bsdf {
 public:
  /// As Conductor.
  RoughConductor(const TexturePtr& eta, const TexturePtr& k, const Roughness& roughness,
                 const TexturePtr& specular_reflectance = nullptr, bool energy_compensation = false);

  lobe::Flags flags() const override { return lobe::kReflection | lobe::kSmooth; }
  Eval eval(const SurfacePoint& point, const Vec3& given, const Vec3& chosen, TransportMode mode) const override;
  std::optional<BsdfSample> sample(const SurfacePoint& point, const Vec3& given, float u_lobe, const Vec2& u,
                                   TransportMode mode) const override;

 private:
  Eval evaluate(const SurfacePoint& point, const MicrofacetDistribution& distribution, const Vec3& given,
                const Vec3& chosen, const Vec3& m) const;

  TextureValue eta_, k_, reflectance_;
  RoughnessValue roughness_;
  EnergyCompensation compensation_;
};

}  // namespace turbid
