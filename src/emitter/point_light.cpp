#include "emitter/point_light.h"

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

}  // namespace turbid
