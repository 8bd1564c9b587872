#include "sensor/thin_lens.h"

#include <stdexcept>

#include "core/warp.h"
#include "sensor/film_plane.h"

namespace turbid {

ThinLensSensor::ThinLensSensor(const Transform& to_world, double x_fov, double aspect, float aperture_radius,
                               float focus_distance, const ClipRange& clip)
    : origin_(to_world.point(Vec3(0))),
      lens_x_(to_world.vector(Vec3(aperture_radius, 0, 0))),
      lens_y_(to_world.vector(Vec3(0, aperture_radius, 0))),
      focus_distance_(focus_distance),
      clip_(clip) {
  check(clip);
  check_rigid(to_world);
  if (!(aperture_radius >= 0)) throw std::invalid_argument("aperture_radius must not be negative");
  if (!(focus_distance > 0)) throw std::invalid_argument("focus_distance must be positive");
  const FilmPlane plane = film_plane(x_fov, aspect, Vec2(0));
  corner_ = to_world.vector(plane.corner);
  across_ = to_world.vector(plane.across);
  down_ = to_world.vector(plane.down);
}

SensorRay ThinLensSensor::sample_ray(const Vec2& film, const Vec2& u_aperture) const {
  const Vec3 offset = lens_offset(u_aperture);
  const Vec3 towards = corner_ + across_ * film.x + down_ * film.y - offset / focus_distance_;  // 1 along the axis
  const float scale = length(towards);
  return {{origin_ + offset, towards / scale, clip_.far_clip * scale}, clip_.near_clip * scale};
}

Vec3 ThinLensSensor::lens_offset(const Vec2& u) const {
  const Vec2 lens = square_to_disk(u);
  return lens_x_ * lens.x + lens_y_ * lens.y;
}

std::optional<SensorConnection> ThinLensSensor::connect(const Vec3& p, const Vec2& u_aperture) const {
  const Vec3 from_lens = p - (origin_ + lens_offset(u_aperture));
  const float distance = length(from_lens);
  return at_distance(connect_to_infinity(from_lens / distance, u_aperture), distance);
}

std::optional<SensorConnection> ThinLensSensor::connect_to_infinity(const Vec3& direction,
                                                                    const Vec2& u_aperture) const {
  const Vec3 offset = lens_offset(u_aperture);
  auto result = connect_through({corner_, across_, down_}, clip_, direction, offset, focus_distance_);
  if (result) result->position = origin_ + offset;
  return result;
}

}  // namespace turbid
