#include "emitter/point_light.h"

#include "core/warp.h"

namespace turbid {

std::optional<DirectLightSample> PointLight::sample_direct(const Vec3& from, const Vec2&) const {
  const Vec3 towards = position_ - from;
  const float distance = length(towards);
  if (!(distance > 0)) return std::nullopt;
  return DirectLightSample{.wi = towards / distance,
                           .distance = distance,
                           .position = position_,
                           .weight = intensity_ / sqr(distance),
                           .delta = true};
}

std::optional<EmissionSample> PointLight::sample_emission(const Vec2&, const Vec2& u_direction) const {
  return EmissionSample{.origin = position_,
                        .direction = square_to_sphere(u_direction),
                        .weight = intensity_ / kUniformSpherePdfW,
                        .pdf = emission_pdf({}, {})};
}

}  // namespace turbid
