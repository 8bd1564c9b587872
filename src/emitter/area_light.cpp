#include "emitter/area_light.h"

#include "core/warp.h"

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
      .pdf_w = sample->pdf_w,
      .ng = sample->point.ng};
}

std::optional<DirectLightSample> AreaLight::seen_from(const Vec3& from, const DirectLightSample& chosen) const {
  const Vec3 towards = chosen.position - from;
  const float distance = length(towards);
  if (!(distance > 0)) return std::nullopt;
  const Vec3 wi = towards / distance;
  if (!(dot(chosen.ng, wi) < 0)) return std::nullopt;
  const float pdf_w = pdf_direct_w(from, chosen.position, chosen.ng);
  if (!(pdf_w > 0)) return std::nullopt;
  return DirectLightSample{.wi = wi,
                           .distance = distance,
                           .position = chosen.position,
                           .weight = chosen.weight * (chosen.pdf_w / pdf_w),
                           .pdf_w = pdf_w,
                           .ng = chosen.ng};
}

std::optional<EmissionSample> AreaLight::sample_emission(const Vec2& u_position, const Vec2& u_direction) const {
  const AreaSample sample = shape_->sample_area(u_position);
  const Vec3 local = square_to_cosine_hemisphere(u_direction);
  const Vec3 direction = Frame(sample.point.ng).to_world(local);
  if (!(local.z > 0)) return std::nullopt;
  return EmissionSample{.origin = sample.point.leave(direction),
                        .direction = direction,
                        .weight = radiance_->eval(sample.point) * (kPi / sample.pdf_a),
                        .pdf = {sample.pdf_a, cosine_hemisphere_pdf_w(local)},
                        .ng = sample.point.ng};
}

}  // namespace turbid
