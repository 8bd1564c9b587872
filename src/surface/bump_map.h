#pragma once
#include "surface/tilted.h"
#include "texture/texture_value.h"

namespace turbid {

/// A material tilted as if the surface were displaced by a height field (Blinn's bump mapping), as Mitsuba 3's
/// `bumpmap`: the tilted normal is that of p + scale h(u, v) n, with the change of n over the surface left out.
class BumpMap final : public Tilted {
 public:
  /// The height is the texture's scalar value, in scene units; null or constant: no tilt.
  BumpMap(TexturePtr height, float scale, BsdfPtr nested, const TiltSettings& settings = {})
      : Tilted(std::move(nested), settings), height_(std::move(height)), scale_(scale) {}

 private:
  Vec3 tilt(const SurfacePoint& point) const override {
    if (!height_) return {0, 0, 1};
    const Vec2 slope = height_->gradient(point) * scale_;
    const Vec3& n = point.shading.n;
    const Vec3 du = point.dp_du + n * (slope.x - dot(n, point.dp_du));
    const Vec3 dv = point.dp_dv + n * (slope.y - dot(n, point.dp_dv));
    const Vec3 normal = cross(du, dv);
    return point.to_local(dot(point.ng, normal) < 0 ? -normal : normal);
  }

  TexturePtr height_;
  float scale_;
};

}  // namespace turbid
