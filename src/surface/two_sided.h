#pragma once
#include "surface/bsdf.h"

namespace turbid {

using BsdfPtr = std::shared_ptr<const Bsdf>;

/// Gives a reflecting material a second side: each side shows its BSDF as if it were the outside.
class TwoSided final : public Bsdf {
 public:
  /// back null: the same as front. A BSDF with transmission cannot be two-sided: std::invalid_argument.
  explicit TwoSided(BsdfPtr front, BsdfPtr back = nullptr);

  lobe::Flags flags() const override { return front_->flags() | back_->flags(); }
  Eval eval(const SurfacePoint& point, const Vec3& given, const Vec3& chosen, TransportMode mode) const override;
  std::optional<BsdfSample> sample(const SurfacePoint& point, const Vec3& given, float u_lobe, const Vec2& u,
                                   TransportMode mode) const override;
  std::optional<Spectrum> diffuse_reflectance(const SurfacePoint& point, const Vec3& given) const override {
    return given.z > 0 ? front_->diffuse_reflectance(point, given)
                       : back_->diffuse_reflectance(point, {given.x, given.y, -given.z});
  }
  Spectrum albedo(const SurfacePoint& point) const override;

 private:
  BsdfPtr front_, back_;
};

}  // namespace turbid
