#pragma once
#include "surface/bsdf.h"
#include "surface/microfacet.h"

namespace turbid {

/// Parameters of PrincipledThin, in [0, 1] unless said otherwise; null textures take the default in brackets.
struct PrincipledThinParameters {
  TexturePtr base_color{};   ///< [0.5]
  TexturePtr roughness{};    ///< alpha = roughness^2 [0.5]
  TexturePtr anisotropic{};  ///< [0]
  TexturePtr spec_trans{};   ///< specular (1) instead of diffuse (0) [0]
  TexturePtr eta{};          ///< index of the sheet over that around it, > 0 [1.5]
  TexturePtr spec_tint{};    ///< tint of reflections by the base colour [0]
  TexturePtr sheen{};        ///< [0]
  TexturePtr sheen_tint{};   ///< [0]
  TexturePtr flatness{};     ///< [0]
  TexturePtr diff_trans{};   ///< in [0, 2]: half of it is the share of diffuse light that goes through [0]
  // How often the lobes are sampled, relative to each other; >= 0, not all 0.
  float specular_reflectance_rate = 1, specular_transmittance_rate = 1;
  float diffuse_reflectance_rate = 1, diffuse_transmittance_rate = 1;
};

/// A sheet of Burley's material, paper or a leaf (Burley 2015), as Mitsuba 3's `principledthin`: alike from both sides;
/// light goes through without being bent, blurred by a roughness that grows with the index.
class PrincipledThin final : public Bsdf {
 public:
  /// Numbers out of range: std::invalid_argument.
  explicit PrincipledThin(const PrincipledThinParameters& parameters);

  lobe::Flags flags() const override { return flags_; }
  Eval eval(const SurfacePoint& point, const Vec3& given, const Vec3& chosen, TransportMode mode) const override;
  std::optional<BsdfSample> sample(const SurfacePoint& point, const Vec3& given, float u_lobe, const Vec2& u,
                                   TransportMode mode) const override;
  Spectrum albedo(const SurfacePoint& point) const override { return base_color_.eval(point); }

 private:
  struct Local;
  Local local(const SurfacePoint& point) const;
  Eval evaluate(const SurfacePoint& point, const Local& local, const Vec3& given, const Vec3& chosen,
                TransportMode mode) const;

  TextureValue base_color_, roughness_, anisotropic_, spec_trans_, eta_, spec_tint_, sheen_, sheen_tint_, flatness_,
      diff_trans_;
  float specular_reflectance_rate_, specular_transmittance_rate_, diffuse_reflectance_rate_,
      diffuse_transmittance_rate_;
  lobe::Flags flags_;
};

}  // namespace turbid
