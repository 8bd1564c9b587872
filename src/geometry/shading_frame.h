#pragma once
#include "core/frame.h"

namespace turbid {

/// Unit roundoff of float: the largest relative error of one rounding.
inline constexpr float kUnitRoundoff = 0x1p-24f;

/// The frame around the unit vector n whose s axis follows dp_du as closely as it can (as in Mitsuba 3).
inline Frame shading_frame(const Vec3& n, const Vec3& dp_du) {
  const Vec3 tangent = dp_du - n * dot(n, dp_du);
  const float norm_squared = length_squared(tangent);
  if (!(norm_squared > 1e-12f * length_squared(dp_du))) return Frame(n);
  const Vec3 s = tangent * (1 / std::sqrt(norm_squared));
  return {s, cross(n, s), n};
}

/// n, normalised and bent as little as possible to the front of ng; ng where n is zero.
inline Vec3 bend_to_front(const Vec3& n, const Vec3& ng) {
  constexpr float kLeastCosine = 1e-3f;  // far enough from the horizon for stable local coordinates
  const float norm = length(n);
  if (!(norm > 0)) return ng;
  const Vec3 unit = n * (1 / norm);
  const float cosine = dot(unit, ng);
  if (cosine >= kLeastCosine) return unit;
  const Vec3 tangent = unit - ng * cosine;
  const float tangent_norm = length(tangent);
  if (!(tangent_norm > 1e-4f)) return ng;  // exactly opposed: no direction to bend in
  return normalize(tangent * (1 / tangent_norm) + ng * kLeastCosine);
}

/// Error bound, along any direction, of a point that was computed exactly and then rounded to float.
inline float rounding_error(const Vec3& p) {
  // Each coordinate errs by at most kUnitRoundoff of its own; the bound on the Euclidean length is theirs.
  return kUnitRoundoff * length(p);
}

}  // namespace turbid
