#pragma once
#include "core/rng.h"
#include "gathering/gather_volume.h"
#include "medium/homogeneous.h"

namespace turbid {

/// A straight piece of a light path through a homogeneous medium.
struct LightSegment {
  Ray ray;        ///< t_max: its end
  Spectrum flux;  ///< at the origin, W
  bool is_long;   ///< reaches to the next surface and carries flux times transmittance; else ends at a collision
  Spectrum mix;   ///< of channels, which the end of a short one was drawn with

  /// What a short or long piece carries at a distance: the expectation over its end is flux times transmittance.
  Spectrum flux_at(float t, const HomogeneousMedium& medium) const {
    const Spectrum passed = medium.transmittance(t);
    if (is_long) return flux * passed;
    return medium.is_grey() ? flux : flux * passed / (mix * passed).sum();
  }
};

/// Where a ray passes a point nearest, or negative: beyond its ends or farther than `radius`.
inline float nearest_within(const Ray& ray, const Vec3& center, float radius) {
  const Vec3 to = center - ray.origin;
  const float t = dot(to, ray.direction);
  if (!(t > 0) || !(t < ray.t_max)) return -1;
  return length_squared(to - ray.direction * t) < sqr(radius) ? t : -1;
}

/// The piece of a ray inside a piece of a cylinder, in distances along the ray.
struct Chord {
  double from = 0, to = 0;
  bool empty() const { return !(from < to); }
};
Chord chord_in(const Ray& ray, const GatherVolume& cylinder);

/// What a light segment adds to the pixel of a piece of a cylinder, but for sigma_s f / (pi R^2): the integral, along
/// the chord, of the segment's flux times the transmittance of the cylinder's flight (S5 eq. 2 and 3, with the signed
/// cosine of NUMERICS 5). `long_cylinder`: the flight's transmittance counts; else what is left of it is a weight.
/// Closed form, but for short ones whose channels differ: those are asked at one random point.
Spectrum flux_through(const LightSegment& segment, const GatherVolume& cylinder, const Chord& chord, bool long_cylinder,
                      const HomogeneousMedium& medium, float u);

/// Transmittance along a short cylinder's flight over the probability of getting there; or the transmittance of a long
/// one.
Spectrum weight_along(const GatherVolume& cylinder, float distance, bool long_cylinder,
                      const HomogeneousMedium& medium);

}  // namespace turbid
