#pragma once
#include <algorithm>

#include "core/vector.h"

namespace turbid {

/// Warps map u in [0,1)^2 to a domain; beside each stands its density in the measure its name tells.

/// Unit disk, uniform: concentric map (Shirley & Chiu 1997); density 1/pi per area.
inline Vec2 square_to_disk(const Vec2& u) {
  const float a = 2 * u.x - 1, b = 2 * u.y - 1;
  if (a == 0 && b == 0) return {0, 0};
  const bool wide = std::abs(a) > std::abs(b);
  const float r = wide ? a : b;
  const float phi = wide ? (kPi / 4) * (b / a) : kPi / 2 - (kPi / 4) * (a / b);
  return {r * std::cos(phi), r * std::sin(phi)};
}

/// Unit sphere, uniform in solid angle.
inline Vec3 square_to_sphere(const Vec2& u) {
  const float z = 1 - 2 * u.y, r = safe_sqrt(1 - z * z), phi = 2 * kPi * u.x;
  return {r * std::cos(phi), r * std::sin(phi), z};
}
inline constexpr float kUniformSpherePdfW = 0.25f * kInvPi;

/// Hemisphere about +z, density cos(theta)/pi in solid angle (Malley).
inline Vec3 square_to_cosine_hemisphere(const Vec2& u) {
  const Vec2 p = square_to_disk(u);
  return {p.x, p.y, safe_sqrt(1 - p.x * p.x - p.y * p.y)};
}
inline float cosine_hemisphere_pdf_w(const Vec3& v) { return std::max(0.0f, v.z) * kInvPi; }

/// Cone about +z with cosine cos_max at its edge, uniform in solid angle.
inline Vec3 square_to_cone(const Vec2& u, float cos_max) {
  const float z = 1 - u.y * (1 - cos_max), r = safe_sqrt(1 - z * z), phi = 2 * kPi * u.x;
  return {r * std::cos(phi), r * std::sin(phi), z};
}
inline float cone_pdf_w(float cos_max) { return 1 / (2 * kPi * (1 - cos_max)); }

/// Barycentric coordinates (b1, b2) of a triangle, uniform in area.
inline Vec2 square_to_triangle(const Vec2& u) {
  const float r = std::sqrt(1 - u.x);
  return {1 - r, u.y * r};
}

/// Tent on [-1, 1]; density 1 - |x|.
inline float interval_to_tent(float u) { return u < 0.5f ? std::sqrt(2 * u) - 1 : 1 - std::sqrt(2 * (1 - u)); }

}  // namespace turbid
