#pragma once
#include <bit>
#include <experimental/simd>
#if defined(__SSE__)
#include <immintrin.h>
#endif

#include "core/vector.h"

namespace turbid {

/// As many floats as the processor's vectors hold, and the functions that it has none for, without branches. Good to a
/// few units in the last place over the ranges named; the polynomials of the Cephes library.
using Lanes = std::experimental::native_simd<float>;
inline constexpr size_t kLanes = Lanes::size();
using IntLanes = std::experimental::rebind_simd_t<int32_t, Lanes>;

inline Lanes select(const Lanes::mask_type& condition, const Lanes& yes, Lanes no) {
  std::experimental::where(condition, no) = yes;
  return no;
}

/// 1 / sqrt(x) for normal x > 0, to a few units in the last place: several times as fast as root and quotient.
inline Lanes inverse_sqrt_lanes(const Lanes& x) {
#if defined(__AVX512F__)
  const auto r = std::bit_cast<Lanes>(_mm512_rsqrt14_ps(std::bit_cast<__m512>(x)));
#elif defined(__AVX__)
  const auto r = std::bit_cast<Lanes>(_mm256_rsqrt_ps(std::bit_cast<__m256>(x)));
#elif defined(__SSE__)
  const auto r = std::bit_cast<Lanes>(_mm_rsqrt_ps(std::bit_cast<__m128>(x)));
#else
  return 1 / sqrt(x);
#endif
#if defined(__SSE__)
  return r * (1.5f - 0.5f * x * r * r);  // a step of Newton's method
#endif
}

/// e^x for |x| <= 80; beyond, as at the limit.
inline Lanes exp_lanes(Lanes x) {
  x = min(max(x, Lanes(-80.0f)), Lanes(80.0f));
  const Lanes n = floor(x * 1.44269504f + 0.5f);
  const Lanes r = x - n * 0.693359375f + n * 2.12194440e-4f;
  Lanes p = 1.9875691500e-4f;
  for (const float c : {1.3981999507e-3f, 8.3334519073e-3f, 4.1665795894e-2f, 1.6666665459e-1f, 5.0000001201e-1f})
    p = p * r + c;
  const IntLanes exponent = (std::experimental::static_simd_cast<IntLanes>(n) + 127) << 23;
  return (p * r * r + r + 1) * std::bit_cast<Lanes>(exponent);
}

/// ln x for normal x > 0.
inline Lanes log_lanes(const Lanes& x) {
  const IntLanes bits = std::bit_cast<IntLanes>(x);
  Lanes exponent = std::experimental::static_simd_cast<Lanes>((bits >> 23) - 126);
  Lanes m = std::bit_cast<Lanes>((bits & 0x007fffff) | 0x3f000000);  // in [1/2, 1)
  const auto small = m < 0.707106781f;
  exponent = select(small, exponent - 1, exponent);
  m = select(small, m + m, m) - 1;
  Lanes p = 7.0376836292e-2f;
  for (const float c : {-1.1514610310e-1f, 1.1676998740e-1f, -1.2420140846e-1f, 1.4249322787e-1f, -1.6668057665e-1f,
                        2.0000714765e-1f, -2.4999993993e-1f, 3.3333331174e-1f})
    p = p * m + c;
  const Lanes z = m * m;
  return p * m * z - exponent * 2.12194440e-4f - z * 0.5f + m + exponent * 0.693359375f;
}

/// The angle of (x, y) for y >= 0, in [0, pi].
inline Lanes angle_lanes(const Lanes& y, const Lanes& x) {
  const Lanes r = sqrt(x * x + y * y), magnitude = max(x, -x);
  const Lanes ratio = y / max(r + magnitude, Lanes(1e-30f));  // tangent of half the angle to the nearer axis, in [0, 1]
  const auto steep = ratio > 0.414213562f;
  const Lanes a = select(steep, (ratio - 1) / (ratio + 1), ratio), z = a * a;
  Lanes p = 8.05374449538e-2f;
  for (const float c : {-1.38776856032e-1f, 1.99777106478e-1f, -3.33329491539e-1f}) p = p * z + c;
  const Lanes half = p * z * a + a + select(steep, Lanes(kPi / 4), Lanes(0.0f));
  return select(x < 0, kPi - 2 * half, 2 * half);
}

/// Sine and cosine of angles in [0, pi].
struct SineCosine {
  Lanes sine, cosine;
};
inline SineCosine sine_cosine_lanes(const Lanes& angle) {
  // Through half the angle to the nearer end, so that small sines keep their digits.
  const auto obtuse = angle > kPi / 2;
  const Lanes x = select(obtuse, kPi - angle, angle) * 0.5f, z = x * x;  // in [0, pi/4]
  const Lanes s = ((-1.9515295891e-4f * z + 8.3321608736e-3f) * z - 1.6666654611e-1f) * z * x + x;
  const Lanes c =
      ((2.443315711809948e-5f * z - 1.388731625493765e-3f) * z + 4.166664568298827e-2f) * z * z - 0.5f * z + 1;
  const Lanes cosine = 1 - 2 * s * s;
  return {2 * s * c, select(obtuse, -cosine, cosine)};
}

}  // namespace turbid
