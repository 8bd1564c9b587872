#pragma once
#include <vector>

#include "texture/texture_value.h"
#include "texture/uv_transform.h"

namespace turbid {

/// A pen's line from one point of the uv square to another.
struct Stroke {
  Vec2 from, to;
};

/// Lines of one width with round ends, drawn on a ground: color0 within half the width of a stroke, color1 elsewhere.
class StrokesTexture final : public Texture {
 public:
  /// `width` in units of uv after `to_uv`, above 0. Missing colours are 0.4 and 0.2.
  StrokesTexture(std::vector<Stroke> strokes, float width, TexturePtr color0, TexturePtr color1,
                 const UvTransform& to_uv = {});

  Spectrum eval(const SurfacePoint& point) const override { return colour(point).eval(point); }
  float eval_scalar(const SurfacePoint& point) const override { return colour(point).eval_scalar(point); }
  Spectrum mean() const override { return color1_.mean() + (color0_.mean() - color1_.mean()) * covered_; }
  float max() const override { return max_; }

 private:
  const TextureValue& colour(const SurfacePoint& point) const;
  bool is_covered(const Vec2& uv) const;

  std::vector<Stroke> strokes_;
  float radius_;
  TextureValue color0_, color1_;
  UvTransform to_uv_;
  float max_, covered_ = 0;
};

}  // namespace turbid
