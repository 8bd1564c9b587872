#pragma once
#include <Imath/ImathBox.h>
#include <Imath/ImathVec.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace turbid {

using Vec2 = Imath::V2f;
using Vec3 = Imath::V3f;
using Vec2i = Imath::V2i;
using Bounds3 = Imath::Box3f;

inline constexpr float kPi = std::numbers::pi_v<float>;
inline constexpr float kInvPi = std::numbers::inv_pi_v<float>;
inline constexpr float kInfinity = std::numeric_limits<float>::infinity();

inline float dot(const Vec3& a, const Vec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vec3 cross(const Vec3& a, const Vec3& b) { return a.cross(b); }
inline float length_squared(const Vec3& v) { return dot(v, v); }
inline float length(const Vec3& v) { return std::sqrt(dot(v, v)); }
/// v / |v|. The zero vector gives NaN: callers decide what a missing direction means.
inline Vec3 normalize(const Vec3& v) { return v * (1 / length(v)); }
inline Vec3 abs(const Vec3& v) { return {std::abs(v.x), std::abs(v.y), std::abs(v.z)}; }
inline float max_component(const Vec3& v) { return std::max({v.x, v.y, v.z}); }

inline constexpr float sqr(float x) { return x * x; }
inline constexpr double sqr(double x) { return x * x; }
/// sqrt(max(0, x)): for quantities that rounding may push below zero.
inline float safe_sqrt(float x) { return std::sqrt(std::max(0.0f, x)); }

}  // namespace turbid
