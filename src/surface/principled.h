#pragma once
#include "surface/bsdf.h"
#include "surface/microfacet.h"

namespace turbid {

/// Parameters of Principled, in [0, 1] unless said otherwise; null textures take the default in brackets.
struct PrincipledParameters {
  TexturePtr base_color{};       ///< [0.5]
  TexturePtr roughness{};        ///< of the main lobes; alpha = roughness^2 [0.5]
  TexturePtr anisotropic{};      ///< [0]
  TexturePtr metallic{};         ///< [0]
  TexturePtr spec_trans{};       ///< share of the light that is refracted instead of scattered by the base [0]
  TexturePtr spec_tint{};        ///< tint of reflections by the base colour [0]
  TexturePtr sheen{};            ///< [0]
  TexturePtr sheen_tint{};       ///< [0]
  TexturePtr flatness{};         ///< [0]
  TexturePtr clearcoat{};        ///< a second, colourless reflection [0]
  TexturePtr clearcoat_gloss{};  ///< [0]
  float eta = 1.5f;              ///< interior / exterior index, > 0
  // How often the lobes are sampled, relative to each other; >= 0, not all 0.
  float diffuse_rate = 1, specular_rate = 1, clearcoat_rate = 1;
};

/// Burley's material for artists (Burley 2012, Burley 2015), with the lobes and weights of Mitsuba 3's `principled`: a
/// diffuse base with sheen, a GGX reflection that is dielectric or metallic, GGX refraction, and a clear coat. From the
/// inside only the dielectric boundary is seen, and nothing without spec_trans.
///
/// The coat and the sheen are added without taking light from the rest: at grazing angles more may leave than came.
class Principled final : public Bsdf {
 public:
  /// Numbers out of range: std::invalid_argument.
  explicit Principled(const PrincipledParameters& parameters);

  lobe::Flags flags() const override { return flags_; }
  Eval eval(const SurfacePoint& point, const Vec3& given, const Vec3& chosen, TransportMode mode) const override;
  std::optional<BsdfSample> sample(const SurfacePoint& point, const Vec3& given, float u_lobe, const Vec2& u,
                                   TransportMode mode) const override;
  Spectrum albedo(const SurfacePoint& point) const override { return base_color_.eval(point); }

  /// The ratio of indices that gives Burley's `specular` in [0, 1]: reflectance 0.08 specular at normal incidence.
  static float eta_of_specular(float specular);

 private:
  struct Local;
  Local local(const SurfacePoint& point, const Vec3& given) const;
  Eval evaluate(const SurfacePoint& point, const Local& local, const Vec3& given, const Vec3& chosen, const Vec3& m,
                TransportMode mode) const;
  Spectrum reflected(const SurfacePoint& point, const Local& local, const Vec3& given, const Vec3& chosen,
                     const Vec3& m, float fresnel) const;

  TextureValue base_color_, roughness_, anisotropic_, metallic_, spec_trans_, spec_tint_, sheen_, sheen_tint_,
      flatness_, clearcoat_, clearcoat_gloss_;
  float eta_, diffuse_rate_, specular_rate_, clearcoat_rate_;
  lobe::Flags flags_;
};

}  // namespace turbid
