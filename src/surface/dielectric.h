#pragma once
#include "surface/bsdf.h"
#include "texture/texture_value.h"

namespace turbid {

/// A smooth boundary between two dielectrics: Fresnel reflection and refraction, both deltas. The outside is where the
/// normal points. Equal indices: light passes as through NullBsdf (times the transmittance factor).
class Dielectric final : public Bsdf {
 public:
  /// Indices > 0 (else std::invalid_argument). The factors colour reflected and transmitted light; null: 1.
  Dielectric(float interior_index, float exterior_index, const TexturePtr& specular_reflectance = nullptr,
             const TexturePtr& specular_transmittance = nullptr);

  lobe::Flags flags() const override { return flags_; }
  Eval eval(const SurfacePoint&, const Vec3&, const Vec3&, TransportMode) const override { return {}; }
  /// Uses u_lobe only.
  std::optional<BsdfSample> sample(const SurfacePoint& point, const Vec3& given, float u_lobe, const Vec2& u,
                                   TransportMode mode) const override;
  Spectrum null_transmission(const SurfacePoint& point, const Vec3& given) const override;
  Spectrum albedo(const SurfacePoint&) const override { return Spectrum(0.0f); }

  /// Interior over exterior index.
  float eta() const { return eta_; }

 private:
  float eta_, inverse_eta_;
  bool plain_;  ///< both factors are 1
  lobe::Flags flags_;
  TextureValue reflectance_, transmittance_;
};

/// A pane so thin that light leaves it undeflected, with all reflections inside of it summed: R' = 2 R / (1 + R), and
/// 1 - R' passes straight on as a null lobe.
class ThinDielectric final : public Bsdf {
 public:
  /// As Dielectric; the interior is the pane's material.
  ThinDielectric(float interior_index, float exterior_index, const TexturePtr& specular_reflectance = nullptr,
                 const TexturePtr& specular_transmittance = nullptr);

  lobe::Flags flags() const override { return lobe::kReflection | lobe::kTransmission | lobe::kNull | lobe::kDelta; }
  Eval eval(const SurfacePoint&, const Vec3&, const Vec3&, TransportMode) const override { return {}; }
  /// Uses u_lobe only.
  std::optional<BsdfSample> sample(const SurfacePoint& point, const Vec3& given, float u_lobe, const Vec2& u,
                                   TransportMode mode) const override;
  Spectrum null_transmission(const SurfacePoint& point, const Vec3& given) const override;
  Spectrum albedo(const SurfacePoint&) const override { return Spectrum(0.0f); }

 private:
  float pane_reflectance(const Vec3& given) const;

  float eta_;
  TextureValue reflectance_, transmittance_;
};

}  // namespace turbid
