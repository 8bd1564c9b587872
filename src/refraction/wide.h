#pragma once
#include <cstring>

#include "refraction/facet.h"

#pragma GCC diagnostic ignored "-Wpsabi"  // about calls between programs for different processors; all here is inlined

/// Arithmetic on eight doubles at once (vectors of GCC and Clang, in as many registers as the processor needs): what
/// comes out does not depend on their width.
namespace turbid::wide {

inline constexpr size_t kLanes = 8;
using Real = double __attribute__((vector_size(kLanes * sizeof(double))));
/// Each lane 0 or -1, as comparisons give it: combine by &, | and ~, choose by mask ? yes : no.
using Mask = decltype(Real{} < Real{});

inline Real all(double value) { return Real{} + value; }
inline Real load(const float* lanes) {
  float __attribute__((vector_size(kLanes * sizeof(float)))) values;
  std::memcpy(&values, lanes, sizeof(values));
  return __builtin_convertvector(values, Real);
}
inline void store(const Real& value, double* lanes) { std::memcpy(lanes, &value, sizeof(value)); }

inline Real square_root(Real x) {
  for (size_t k = 0; k < kLanes; ++k) x[k] = std::sqrt(x[k]);
  return x;
}
inline Real least(const Real& a, const Real& b) { return a < b ? a : b; }
inline Real most(const Real& a, const Real& b) { return a > b ? a : b; }
inline Real magnitude(const Real& a) { return a < 0 ? -a : a; }

/// A bit per lane, lane 0 lowest.
inline uint32_t bits(const Mask& mask) {
  uint32_t result = 0;
  for (size_t k = 0; k < kLanes; ++k) result |= static_cast<uint32_t>(mask[k] & 1) << k;
  return result;
}

struct Vector {
  Real x, y, z;

  Vector operator+(const Vector& o) const { return {x + o.x, y + o.y, z + o.z}; }
  Vector operator-(const Vector& o) const { return {x - o.x, y - o.y, z - o.z}; }
  Vector operator-() const { return {-x, -y, -z}; }
  Vector operator*(const Real& s) const { return {x * s, y * s, z * s}; }
};

inline Vector all(const V3d& v) { return {all(v.x), all(v.y), all(v.z)}; }
inline Vector load(const float lanes[3][kLanes]) { return {load(lanes[0]), load(lanes[1]), load(lanes[2])}; }
inline Real dot(const Vector& a, const Vector& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Real norm2(const Vector& v) { return dot(v, v); }
inline Vector unit(const Vector& v) { return v * (1 / square_root(norm2(v))); }
inline Vector cross(const Vector& a, const Vector& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline Vector choose(const Mask& mask, const Vector& yes, const Vector& no) {
  return {mask ? yes.x : no.x, mask ? yes.y : no.y, mask ? yes.z : no.z};
}

}  // namespace turbid::wide
