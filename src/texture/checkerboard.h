#pragma once
#include "texture/texture_value.h"
#include "texture/uv_transform.h"

namespace turbid {

/// Squares of side 1/2 in uv after `to_uv`: color0 where both or neither of the fractional parts of u and v exceed 1/2,
/// color1 elsewhere (as Mitsuba 3's `checkerboard`; defaults there: 0.4 and 0.2).
class CheckerboardTexture final : public Texture {
 public:
  CheckerboardTexture(TexturePtr color0, TexturePtr color1, const UvTransform& to_uv = {});

  Spectrum eval(const SurfacePoint& point) const override { return square(point).eval(point); }
  float eval_scalar(const SurfacePoint& point) const override { return square(point).eval_scalar(point); }
  Spectrum mean() const override;
  float max() const override { return max_; }

 private:
  const TextureValue& square(const SurfacePoint& point) const;

  TextureValue color0_, color1_;
  UvTransform to_uv_;
  float max_;
};

}  // namespace turbid
