#pragma once
#include "surface/bsdf.h"
#include "surface/energy_compensation.h"
#include "surface/microfacet.h"

namespace turbid {

/// A rough boundary between two dielectrics: microfacets that reflect and refract (Walter et al. 2007), single
/// scattering, separable Smith masking, as Mitsuba 3's `roughdielectric`. Rough surfaces lose the light that would hit
/// a second facet; `energy_compensation` gives it back (see EnergyTable), for colourless factors exactly up to
/// tabulation.
///
/// Equal indices leave half vectors undefined: then it is a null boundary.
class RoughDielectric final : public Bsdf {
 public:
  /// Indices > 0 (else std::invalid_argument); factors null: 1.
  RoughDielectric(float interior_index, float exterior_index, const Roughness& roughness,
                  const TexturePtr& specular_reflectance = nullptr, const TexturePtr& specular_transmittance = nullptr,
                  bool energy_compensation = false);

  lobe::Flags flags() const override;
  Eval eval(const SurfacePoint& point, const Vec3& given, const Vec3& chosen, TransportMode mode) const override;
  std::optional<BsdfSample> sample(const SurfacePoint& point, const Vec3& given, float u_lobe, const Vec2& u,
                                   TransportMode mode) const override;
  Spectrum null_transmission(const SurfacePoint& point, const Vec3& given) const override;

  /// Interior over exterior index.
  float eta() const { return eta_; }

 private:
  struct Lobes;
  Lobes lobes(const SurfacePoint& point, const Vec3& given) const;
  Eval evaluate(const SurfacePoint& point, const Lobes& lobes, const Vec3& given, const Vec3& chosen, const Vec3& m,
                TransportMode mode) const;

  float eta_;
  RoughnessValue roughness_;
  TextureValue reflectance_, transmittance_;
  EnergyCompensation compensation_;
};

}  // namespace turbid
