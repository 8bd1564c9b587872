#pragma once
#include "surface/two_sided.h"
#include "texture/texture_value.h"

namespace turbid {

/// A material with holes: the nested BSDF with weight opacity, light passing straight on with weight 1 - opacity.
class Mask final : public Bsdf {
 public:
  /// opacity is clamped to [0, 1]; null: 0.5. A missing nested BSDF is std::invalid_argument.
  Mask(const TexturePtr& opacity, BsdfPtr nested);

  lobe::Flags flags() const override;
  Eval eval(const SurfacePoint& point, const Vec3& given, const Vec3& chosen, TransportMode mode) const override;
  std::optional<BsdfSample> sample(const SurfacePoint& point, const Vec3& given, float u_lobe, const Vec2& u,
                                   TransportMode mode) const override;
  Spectrum null_transmission(const SurfacePoint& point, const Vec3& given) const override;
  Spectrum albedo(const SurfacePoint& point) const override;

 private:
  float opacity(const SurfacePoint& point) const;

  TextureValue opacity_;
  BsdfPtr nested_;
};

}  // namespace turbid
