#include "emitter/collimated_beam.h"

#include <stdexcept>

#include "core/warp.h"

namespace turbid {

CollimatedBeam::CollimatedBeam(const Transform& to_world, const Spectrum& power, float radius)
    : center_(to_world.point(Vec3(0))),
      axis_(normalize(to_world.vector(Vec3(0, 0, 1)))),
      power_(power),
      radius_(radius) {
  if (!(radius >= 0) || !std::isfinite(radius))
    throw std::invalid_argument("the radius of a collimated beam must be finite and not negative");
}

std::optional<EmissionSample> CollimatedBeam::sample_emission(const Vec2& u_position, const Vec2&) const {
  const Vec2 disk = square_to_disk(u_position) * radius_;
  return EmissionSample{.origin = center_ + axis_.s * disk.x + axis_.t * disk.y,
                        .direction = axis_.n,
                        .weight = power_,
                        .pdf = emission_pdf({}, axis_.n)};
}

EmissionPdf CollimatedBeam::emission_pdf(const Vec3&, const Vec3&) const {
  return {radius_ > 0 ? 1 / (kPi * sqr(radius_)) : 0, 0};
}

Bounds3 CollimatedBeam::bounds() const {
  Bounds3 result;
  // A disk reaches sqrt(1 - n_i^2) of its radius along axis i.
  const Vec3& n = axis_.n;
  const Vec3 reach = Vec3(safe_sqrt(1 - sqr(n.x)), safe_sqrt(1 - sqr(n.y)), safe_sqrt(1 - sqr(n.z))) * radius_;
  result.extendBy(center_ - reach);
  result.extendBy(center_ + reach);
  return result;
}

}  // namespace turbid
