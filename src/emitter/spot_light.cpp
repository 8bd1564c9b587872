#include "emitter/spot_light.h"

#include <stdexcept>

#include "core/warp.h"

namespace turbid {
namespace {
float radians(float degrees) { return degrees * (kPi / 180); }
}  // namespace

SpotLight::SpotLight(const Transform& to_world, const Spectrum& intensity, float cutoff_angle, float beam_width,
                     std::shared_ptr<const Texture> texture)
    : to_local_(to_world.inverse()),
      position_(to_world.point(Vec3(0))),
      axis_(normalize(to_world.vector(Vec3(0, 0, 1)))),
      intensity_(intensity),
      cutoff_(radians(cutoff_angle)),
      beam_(radians(beam_width)),
      cos_cutoff_(std::cos(cutoff_)),
      cos_beam_(std::cos(beam_)),
      inverse_transition_(1 / (cutoff_ - beam_)),
      tan_cutoff_(std::tan(cutoff_)),
      texture_(std::move(texture)) {
  if (!(cutoff_angle > 0 && cutoff_angle <= 180))
    throw std::invalid_argument("the cutoff angle of a spot light must lie in (0, 180] degrees");
  if (!(beam_width >= 0 && beam_width <= cutoff_angle))
    throw std::invalid_argument("the beam width of a spot light must lie between 0 and its cutoff angle");
  if (texture_ && !(cutoff_angle < 90))
    throw std::invalid_argument("a spot light with a texture needs a cutoff angle below 90 degrees");
}

Spectrum SpotLight::intensity(const Vec3& direction) const {
  const Vec3 local = normalize(to_local_.vector(direction));
  if (!(local.z > cos_cutoff_)) return Spectrum();
  const float falloff = local.z >= cos_beam_ ? 1 : std::max(0.0f, (cutoff_ - std::acos(local.z)) * inverse_transition_);
  if (!texture_) return intensity_ * falloff;
  SurfacePoint point;
  point.p = position_;
  point.uv = Vec2(local.x, local.y) / (2 * local.z * tan_cutoff_) + Vec2(0.5f);
  return intensity_ * texture_->eval(point) * falloff;
}

std::optional<DirectLightSample> SpotLight::sample_direct(const Vec3& from, const Vec2&) const {
  const Vec3 towards = position_ - from;
  const float distance = length(towards);
  if (!(distance > 0)) return std::nullopt;
  const Vec3 wi = towards / distance;
  const Spectrum value = intensity(-wi);
  if (value.is_black()) return std::nullopt;
  return DirectLightSample{
      .wi = wi, .distance = distance, .position = position_, .weight = value / sqr(distance), .delta = true};
}

std::optional<EmissionSample> SpotLight::sample_emission(const Vec2&, const Vec2& u_direction) const {
  const Vec3 direction = axis_.to_world(square_to_cone(u_direction, cos_cutoff_));
  const float pdf_w = cone_pdf_w(cos_cutoff_);
  return EmissionSample{
      .origin = position_, .direction = direction, .weight = intensity(direction) / pdf_w, .pdf = {0, pdf_w}};
}

EmissionPdf SpotLight::emission_pdf(const Vec3&, const Vec3& direction) const {
  return {0, dot(axis_.n, direction) >= cos_cutoff_ ? cone_pdf_w(cos_cutoff_) : 0};
}

Spectrum SpotLight::power() const {
  // 2 pi (int_0^b sin + int_b^c (c - theta) / (c - b) sin) dtheta = 2 pi (1 - (sin c - sin b) / (c - b))
  const double c = static_cast<double>(cutoff_), b = static_cast<double>(beam_);
  const double slope = c - b > 1e-6 ? (std::sin(c) - std::sin(b)) / (c - b) : std::cos(c);
  const Spectrum whole = intensity_ * static_cast<float>(2 * std::numbers::pi * (1 - slope));
  return texture_ ? whole * texture_->mean() : whole;
}

}  // namespace turbid
