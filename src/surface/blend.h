#pragma once
#include "surface/two_sided.h"
#include "texture/texture_value.h"

namespace turbid {

/// Two materials mixed: the first with weight 1 - w, the second with weight w, as Mitsuba 3's `blendbsdf`.
class Blend final : public Bsdf {
 public:
  /// w = `weight` is clamped to [0, 1]; null: 0.5. A missing material is std::invalid_argument.
  Blend(const TexturePtr& weight, BsdfPtr first, BsdfPtr second);

  lobe::Flags flags() const override { return first_->flags() | second_->flags(); }
  Eval eval(const SurfacePoint& point, const Vec3& given, const Vec3& chosen, TransportMode mode) const override;
  std::optional<BsdfSample> sample(const SurfacePoint& point, const Vec3& given, float u_lobe, const Vec2& u,
                                   TransportMode mode) const override;
  Spectrum null_transmission(const SurfacePoint& point, const Vec3& given) const override;
  Spectrum albedo(const SurfacePoint& point) const override;

 private:
  float weight(const SurfacePoint& point) const;

  TextureValue weight_;
  BsdfPtr first_, second_;
};

}  // namespace turbid
