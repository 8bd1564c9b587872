#pragma once
#include "geometry/surface_point.h"

namespace turbid {

/// Correction of what a walk from a light carries for shading normals (Veach 1997, sect. 5.3), directions away from the
/// surface: given (to where the light comes from) and chosen (to where it goes on). A bsdf turns the flux that arrives
/// into f |cos_s(chosen)|, cosines by the shading normal; light that obeys the same scattering seen from the sensor,
/// f |cos_s(given)|, must instead be f |cos_s(given)| |cos_g(chosen)| / |cos_g(given)| when followed from its source.
/// This is the ratio of the two; it holds for specular refraction as well. 0 where the normals disagree about the side
/// of either direction: there is no transport. Unbounded at grazing angles.
inline float adjoint_correction(const SurfacePoint& point, const Vec3& given, const Vec3& chosen) {
  const float given_s = dot(given, point.shading.n), given_g = dot(given, point.ng);
  const float chosen_s = dot(chosen, point.shading.n), chosen_g = dot(chosen, point.ng);
  if (!(given_s * given_g > 0) || !(chosen_s * chosen_g > 0)) return 0;
  return (chosen_g / chosen_s) * (given_s / given_g);
}

}  // namespace turbid
