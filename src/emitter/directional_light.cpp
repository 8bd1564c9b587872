#include "emitter/directional_light.h"

#include <stdexcept>

namespace turbid {

DirectionalLight::DirectionalLight(const Vec3& direction, const Spectrum& irradiance)
    : direction_(normalize(direction)), irradiance_(irradiance) {
  if (!(length(direction) > 0)) throw std::invalid_argument("the direction of a directional light is zero");
}

void DirectionalLight::set_scene_bounds(const Vec3& center, float radius) {
  center_ = center;
  radius_ = radius;
}

std::optional<DirectLightSample> DirectionalLight::sample_direct(const Vec3&, const Vec2&) const {
  return DirectLightSample{
      .wi = -direction_, .distance = kInfinity, .position = Vec3(0), .weight = irradiance_, .delta = true};
}

std::optional<EmissionSample> DirectionalLight::sample_emission(const Vec2& u_position, const Vec2&) const {
  return EmissionSample{.origin = start_from_infinity(center_, radius_, direction_, u_position),
                        .direction = direction_,
                        .weight = power(),
                        .pdf = emission_pdf({}, direction_)};
}

}  // namespace turbid
