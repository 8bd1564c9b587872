#pragma once
#include "core/transform.h"

namespace turbid {

/// The affine map of surface parameters that a texture's `to_uv` gives: the first two rows of a 4x4 transform, its
/// columns for x, y and translation; z takes no part (as in Mitsuba 3).
class UvTransform {
 public:
  UvTransform() = default;
  explicit UvTransform(const Transform& t)
      : u_{static_cast<float>(t.at(0, 0)), static_cast<float>(t.at(0, 1)), static_cast<float>(t.at(0, 3))},
        v_{static_cast<float>(t.at(1, 0)), static_cast<float>(t.at(1, 1)), static_cast<float>(t.at(1, 3))} {}

  Vec2 operator()(const Vec2& uv) const { return {u_.x * uv.x + u_.y * uv.y + u_.z, v_.x * uv.x + v_.y * uv.y + v_.z}; }

  /// The gradient by the surface's parameters of a function whose gradient by the mapped ones is g.
  Vec2 pull_back(const Vec2& g) const { return {u_.x * g.x + v_.x * g.y, u_.y * g.x + v_.y * g.y}; }

 private:
  Vec3 u_{1, 0, 0}, v_{0, 1, 0};
};

}  // namespace turbid
