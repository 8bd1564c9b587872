#pragma once
#include <memory>

#include "emitter/emitter.h"
#include "texture/texture.h"

namespace turbid {

/// A shape that shines from its outside, alike in all directions. Mitsuba's `area`.
class AreaLight final : public SurfaceEmitter {
 public:
  /// Radiance in W/(sr m^2).
  AreaLight(std::shared_ptr<const Shape> shape, std::shared_ptr<const Texture> radiance)
      : shape_(std::move(shape)), radiance_(std::move(radiance)) {}

  /// Empty where the drawn point turns its back on `from`.
  std::optional<DirectLightSample> sample_direct(const Vec3& from, const Vec2& u) const override;
  std::optional<DirectLightSample> seen_from(const Vec3& from, const DirectLightSample& chosen) const override;
  /// Uniform over the surface, cosine-distributed about its geometric normal.
  std::optional<EmissionSample> sample_emission(const Vec2& u_position, const Vec2& u_direction) const override;
  EmissionPdf emission_pdf(const Vec3& ng, const Vec3& direction) const override {
    return {shape_->pdf_a(), std::max(0.0f, dot(ng, direction)) * kInvPi};
  }
  /// The geometric normal decides which side is the outside.
  Spectrum Le(const SurfacePoint& point, const Vec3& w) const override {
    return dot(point.ng, w) > 0 ? radiance_->eval(point) : Spectrum();
  }
  float pdf_direct_w(const Vec3& from, const Vec3& p, const Vec3& ng) const override {
    return shape_->pdf_direct_w(from, p, ng);
  }
  std::optional<Spectrum> emission_towards(const EmissionSample& ray, const Vec3& direction) const override {
    return ray.weight * (std::max(0.0f, dot(ray.ng, direction)) * kInvPi);
  }
  Bounds3 bounds() const override { return shape_->bounds(); }
  /// pi times area times the mean radiance over the texture: exact where the texture is constant.
  Spectrum power() const override { return radiance_->mean() * (kPi * shape_->area()); }

 private:
  std::shared_ptr<const Shape> shape_;
  std::shared_ptr<const Texture> radiance_;
};

}  // namespace turbid
