#include "emitter/projector.h"

#include <stdexcept>

namespace turbid {

Projector::Projector(const Transform& to_world, std::shared_ptr<const Texture> irradiance, float scale, double x_fov,
                     double aspect)
    : to_world_(to_world),
      to_local_(to_world.inverse()),
      position_(to_world.point(Vec3(0))),
      irradiance_(std::move(irradiance)),
      scale_(scale),
      half_width_(static_cast<float>(std::tan(x_fov * std::numbers::pi / 360))),
      half_height_(static_cast<float>(static_cast<double>(half_width_) / aspect)) {
  if (!irradiance_) throw std::invalid_argument("a projector needs a picture");
  if (!(x_fov > 0 && x_fov < 180))
    throw std::invalid_argument("the horizontal field of view must lie between 0 and 180 degrees, both excluded");
  if (!(aspect > 0)) throw std::invalid_argument("the aspect of a picture must be positive");
  constexpr double kTolerance = 1e-3;  // decimal matrices in scene files
  if (!(std::abs(to_world.uniform_scale() - 1) < kTolerance))
    throw std::invalid_argument("the to_world transform of a projector must not scale or shear");
}

Spectrum Projector::intensity(const Vec3& direction) const {
  const Vec3 local = normalize(to_local_.vector(direction));
  if (!(local.z > 0)) return Spectrum();
  SurfacePoint point;
  point.p = position_;
  // +x points to the left of the picture and +y up.
  point.uv = Vec2(0.5f - local.x / (2 * local.z * half_width_), 0.5f - local.y / (2 * local.z * half_height_));
  const bool inside = point.uv.x >= 0 && point.uv.x <= 1 && point.uv.y >= 0 && point.uv.y <= 1;
  if (!inside) return Spectrum();
  return irradiance_->eval(point) * (kPi * scale_ / (local.z * sqr(local.z)));
}

std::optional<DirectLightSample> Projector::sample_direct(const Vec3& from, const Vec2&) const {
  const Vec3 towards = position_ - from;
  const float distance = length(towards);
  if (!(distance > 0)) return std::nullopt;
  const Vec3 wi = towards / distance;
  const Spectrum value = intensity(-wi);
  if (value.is_black()) return std::nullopt;
  return DirectLightSample{
      .wi = wi, .distance = distance, .position = position_, .weight = value / sqr(distance), .delta = true};
}

std::optional<EmissionSample> Projector::sample_emission(const Vec2&, const Vec2& u_direction) const {
  SurfacePoint point;
  point.p = position_;
  point.uv = u_direction;
  const Spectrum value = irradiance_->eval(point);
  if (value.is_black()) return std::nullopt;
  const Vec3 towards((1 - 2 * u_direction.x) * half_width_, (1 - 2 * u_direction.y) * half_height_, 1);
  const float area = 4 * half_width_ * half_height_, distance = length(towards);
  return EmissionSample{.origin = position_,
                        .direction = normalize(to_world_.vector(towards)),
                        .weight = value * (kPi * scale_ * area),
                        .pdf = {0, distance * sqr(distance) / area}};
}

EmissionPdf Projector::emission_pdf(const Vec3&, const Vec3& direction) const {
  const Vec3 local = to_local_.vector(direction);
  const bool inside =
      local.z > 0 && std::abs(local.x) <= half_width_ * local.z && std::abs(local.y) <= half_height_ * local.z;
  if (!inside) return {};
  const float cosine = local.z / length(local);
  return {0, 1 / (4 * half_width_ * half_height_ * cosine * cosine * cosine)};
}

Spectrum Projector::power() const {
  // int I dw = int pi scale E / cos^3 dw, and cos^3 dA = dw on the plane at distance 1.
  return irradiance_->mean() * (kPi * scale_ * 4 * half_width_ * half_height_);
}

}  // namespace turbid
