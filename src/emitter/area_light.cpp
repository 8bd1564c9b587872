#include "emitter/area_light.h"

namespace turbid {

std::optional<DirectLightSample> AreaLight::sample_direct(const Vec3& from, const Vec2& u) const {
  const auto sample = shape_->sample_direct(from, u);
  if (!sample || !(sample->pdf_w > 0)) return std::nullopt;
  const Vec3 towards = sample->point.p - from;
  const float distance = length(towards);
  if (!(distance > 0)) return std::nullopt;
  const Vec3 wi = towards / distance;
  if (!(dot(sample->point.ng, wi) < 0)) return std::nullopt;
  return DirectLightSample{
      .wi = wi,
      .distance = distance,
      .position = sample->point.leave(-wi),  // off the light itself, so that it does not shade itself
      .weight = radiance_->eval(sample->point) / sample->pdf_w,
      .pdf_w = sample->pdf_w};
}

}  // namespace turbid
