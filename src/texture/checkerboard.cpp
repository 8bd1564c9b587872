#include "texture/checkerboard.h"

#include <algorithm>

namespace turbid {
namespace {
constexpr float kDefault0 = 0.4f, kDefault1 = 0.2f;
}

CheckerboardTexture::CheckerboardTexture(TexturePtr color0, TexturePtr color1, const UvTransform& to_uv)
    : color0_(color0, kDefault0),
      color1_(color1, kDefault1),
      to_uv_(to_uv),
      max_(std::max(color0 ? color0->max() : kDefault0, color1 ? color1->max() : kDefault1)) {}

Spectrum CheckerboardTexture::mean() const { return (color0_.mean() + color1_.mean()) * 0.5f; }

const TextureValue& CheckerboardTexture::square(const SurfacePoint& point) const {
  const Vec2 uv = to_uv_(point.uv);
  const bool right = uv.x - std::floor(uv.x) > 0.5f, upper = uv.y - std::floor(uv.y) > 0.5f;
  return right == upper ? color0_ : color1_;
}

}  // namespace turbid
