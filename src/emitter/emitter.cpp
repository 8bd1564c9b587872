#include "emitter/emitter.h"

#include "core/frame.h"
#include "core/warp.h"

namespace turbid {

Vec3 start_from_infinity(const Vec3& center, float radius, const Vec3& direction, const Vec2& u) {
  const Vec2 disk = square_to_disk(u) * radius;
  const float back = safe_sqrt(sqr(radius) - disk.x * disk.x - disk.y * disk.y);
  return center + Frame(direction).to_world({disk.x, disk.y, -back});
}

std::optional<EmissionSample> EnvironmentEmitter::sample_emission(const Vec2& u_position,
                                                                  const Vec2& u_direction) const {
  const auto towards = sample_direct(center_, u_direction);
  if (!towards) return std::nullopt;
  const Vec3 direction = -towards->wi;
  return EmissionSample{.origin = start_from_infinity(center_, radius_, direction, u_position),
                        .direction = direction,
                        .weight = towards->weight * disk_area(),
                        .pdf = {1 / disk_area(), towards->pdf_w}};
}

}  // namespace turbid
