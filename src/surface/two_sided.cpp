#include "surface/two_sided.h"

#include <stdexcept>

namespace turbid {
namespace {
Vec3 mirrored(const Vec3& v) { return {v.x, v.y, -v.z}; }
}  // namespace

TwoSided::TwoSided(BsdfPtr front, BsdfPtr back) : front_(std::move(front)), back_(back ? std::move(back) : front_) {
  if (!front_) throw std::invalid_argument("a two-sided material needs a nested one");
  if ((front_->flags() | back_->flags()) & lobe::kTransmission)
    throw std::invalid_argument("only materials without transmission can be two-sided");
}

Bsdf::Eval TwoSided::eval(const SurfacePoint& point, const Vec3& given, const Vec3& chosen, TransportMode mode) const {
  if (given.z > 0) return front_->eval(point, given, chosen, mode);
  return back_->eval(point, mirrored(given), mirrored(chosen), mode);
}

std::optional<BsdfSample> TwoSided::sample(const SurfacePoint& point, const Vec3& given, float u_lobe, const Vec2& u,
                                           TransportMode mode) const {
  if (given.z > 0) return front_->sample(point, given, u_lobe, u, mode);
  std::optional<BsdfSample> result = back_->sample(point, mirrored(given), u_lobe, u, mode);
  if (result) result->direction = mirrored(result->direction);
  return result;
}

Spectrum TwoSided::albedo(const SurfacePoint& point) const {
  return (front_->albedo(point) + back_->albedo(point)) * 0.5f;
}

}  // namespace turbid
