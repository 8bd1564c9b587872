#include "texture/strokes.h"

#include <algorithm>

namespace turbid {
namespace {

constexpr float kDefault0 = 0.4f, kDefault1 = 0.2f;

float distance_squared(const Vec2& p, const Stroke& stroke) {
  const Vec2 along = stroke.to - stroke.from, from = p - stroke.from;
  const float norm2 = along.x * along.x + along.y * along.y;
  const float t = norm2 > 0 ? std::clamp((from.x * along.x + from.y * along.y) / norm2, 0.0f, 1.0f) : 0;
  const Vec2 rest = from - along * t;
  return rest.x * rest.x + rest.y * rest.y;
}

}  // namespace

StrokesTexture::StrokesTexture(std::vector<Stroke> strokes, float width, TexturePtr color0, TexturePtr color1,
                               const UvTransform& to_uv)
    : strokes_(std::move(strokes)),
      radius_(width / 2),
      color0_(color0, kDefault0),
      color1_(color1, kDefault1),
      to_uv_(to_uv),
      max_(std::max(color0 ? color0->max() : kDefault0, color1 ? color1->max() : kDefault1)) {
  constexpr int kSide = 64;  // for an estimate
  int covered = 0;
  for (int i = 0; i < kSide * kSide; ++i)
    covered +=
        is_covered({(static_cast<float>(i % kSide) + 0.5f) / kSide, (static_cast<float>(i / kSide) + 0.5f) / kSide});
  covered_ = static_cast<float>(covered) / (kSide * kSide);
}

const TextureValue& StrokesTexture::colour(const SurfacePoint& point) const {
  return is_covered(point.uv) ? color0_ : color1_;
}

bool StrokesTexture::is_covered(const Vec2& uv) const {
  const Vec2 p = to_uv_(uv);
  return std::any_of(strokes_.begin(), strokes_.end(),
                     [&](const Stroke& stroke) { return distance_squared(p, stroke) < sqr(radius_); });
}

}  // namespace turbid
