#pragma once
#include <array>
#include <experimental/simd>
#include <numbers>

#include "core/vector.h"

namespace turbid {

/// Eight numbers side by side: samples, or the orders of spherical harmonics.
inline constexpr size_t kLanes = 8;
using Lanes = std::experimental::simd<float, std::experimental::simd_abi::deduce_t<float, kLanes>>;
using LaneRow = std::array<float, kLanes>;

inline Lanes load_lanes(const float* row) { return Lanes(row, std::experimental::element_aligned); }
inline Lanes load_lanes(const LaneRow& row) { return load_lanes(row.data()); }
inline LaneRow to_row(const Lanes& lanes) {
  LaneRow row;
  lanes.copy_to(row.data(), std::experimental::element_aligned);
  return row;
}

/// Eight vectors.
struct Vec3Lanes {
  Lanes x, y, z;

  friend Vec3Lanes operator+(const Vec3Lanes& a, const Vec3Lanes& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend Vec3Lanes operator-(const Vec3Lanes& a, const Vec3Lanes& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend Vec3Lanes operator*(const Vec3Lanes& a, const Lanes& s) { return {a.x * s, a.y * s, a.z * s}; }
};
inline Vec3Lanes lanes_of(const Vec3& v) { return {Lanes(v.x), Lanes(v.y), Lanes(v.z)}; }
inline Lanes dot(const Vec3Lanes& a, const Vec3Lanes& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

// One name for numbers and for lanes of them.
inline float clamped(float x, float low, float high) { return std::clamp(x, low, high); }
inline Lanes clamped(const Lanes& x, float low, float high) {
  return std::experimental::min(std::experimental::max(x, Lanes(low)), Lanes(high));
}
inline Lanes safe_sqrt(const Lanes& x) { return std::experimental::sqrt(std::experimental::max(x, Lanes(0.0f))); }
inline Vec3Lanes normalize(const Vec3Lanes& v) { return v * (1 / std::experimental::sqrt(dot(v, v))); }

/// Frame(n) of eight unit vectors.
struct FrameLanes {
  Vec3Lanes s, t, n;

  explicit FrameLanes(const Vec3Lanes& normal) : n(normal) {
    const Lanes sign = std::experimental::copysign(Lanes(1.0f), n.z);
    const Lanes a = -1 / (sign + n.z), b = n.x * n.y * a;
    s = {1 + sign * n.x * n.x * a, sign * b, -sign * n.x};
    t = {b, sign + n.y * n.y * a, -n.y};
  }
  Vec3Lanes to_local(const Vec3Lanes& v) const { return {dot(v, s), dot(v, t), dot(v, n)}; }
  Vec3Lanes to_world(const Vec3Lanes& v) const { return s * v.x + t * v.y + n * v.z; }
};

/// Natural logarithm of positive, normal numbers, to 2e-7 of itself or of ln 2 (the larger one far from 1).
inline Lanes log_lanes(const Lanes& x) {
  namespace stdx = std::experimental;
  // x = m 2^e with m in [sqrt(1/2), sqrt(2)]; ln m = 2 artanh(s), s = (m - 1) / (m + 1), |s| < 0.172.
  stdx::fixed_size_simd<int, kLanes> exponent;
  Lanes m = stdx::frexp(x, &exponent);
  Lanes e = stdx::static_simd_cast<Lanes>(exponent);
  const auto small = m < std::numbers::sqrt2_v<float> / 2;
  stdx::where(small, m) = m + m;
  stdx::where(small, e) = e - 1;
  const Lanes s = (m - 1) / (m + 1), s2 = s * s;
  // The term in s^11 is below 4e-9 of the first one.
  return e * std::numbers::ln2_v<float> +
         2 * s * (1 + s2 * (1.0f / 3 + s2 * (1.0f / 5 + s2 * (1.0f / 7 + s2 * (1.0f / 9)))));
}

/// e^x to 2e-7 of itself where -87 < x < 88; below that it is 0.
inline Lanes exp_lanes(const Lanes& x) {
  namespace stdx = std::experimental;
  // x = n ln 2 + r, |r| <= (ln 2) / 2; n (ln 2) in two parts, the first one of 9 bits.
  const Lanes n = stdx::floor(x * (1 / std::numbers::ln2_v<float>)+0.5f);
  const Lanes r = (x - n * 0x1.63p-1f) - n * static_cast<float>(std::numbers::ln2 - 0x1.63p-1);
  // The term in r^8 is 5e-9.
  const Lanes power =
      1 +
      r * (1 + r * (1.0f / 2) *
                   (1 + r * (1.0f / 3) *
                            (1 + r * (1.0f / 4) * (1 + r * (1.0f / 5) * (1 + r * (1.0f / 6) * (1 + r * (1.0f / 7)))))));
  Lanes result = stdx::ldexp(power, stdx::static_simd_cast<stdx::fixed_size_simd<int, kLanes>>(n));
  stdx::where(x < -87.0f, result) = Lanes(0.0f);
  return result;
}

/// cos and sin of 2 pi u, 0 <= u <= 1, to 3e-7.
struct TurnLanes {
  Lanes cosine, sine;

  explicit TurnLanes(const Lanes& u) {
    namespace stdx = std::experimental;
    // The nearest quarter turn, and an angle of at most pi/4 from there by Taylor's series.
    const Lanes quarter = stdx::floor(4 * u + 0.5f);
    const Lanes r = (4 * u - quarter) * (kPi / 2), r2 = r * r;
    const Lanes s =
        r * (1 - r2 * (1.0f / 6) * (1 - r2 * (1.0f / 20) * (1 - r2 * (1.0f / 42) * (1 - r2 * (1.0f / 72)))));
    const Lanes c = 1 - r2 * 0.5f * (1 - r2 * (1.0f / 12) * (1 - r2 * (1.0f / 30) * (1 - r2 * (1.0f / 56))));
    const auto odd = quarter == 1 || quarter == 3, back = quarter == 2 || quarter == 3,
               low = quarter == 1 || quarter == 2;
    cosine = c;
    sine = s;
    stdx::where(odd, cosine) = s;
    stdx::where(odd, sine) = c;
    stdx::where(low, cosine) = -cosine;
    stdx::where(back, sine) = -sine;
  }
};

}  // namespace turbid
