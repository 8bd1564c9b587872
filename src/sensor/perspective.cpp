#include "sensor/perspective.h"

#include "sensor/film_plane.h"

namespace turbid {

PerspectiveSensor::PerspectiveSensor(const Transform& to_world, double x_fov, double aspect, const ClipRange& clip,
                                     const Vec2& principal_point_offset)
    : origin_(to_world.point(Vec3(0))), clip_(clip) {
  check(clip);
  check_rigid(to_world);
  const FilmPlane plane = film_plane(x_fov, aspect, principal_point_offset);
  corner_ = to_world.vector(plane.corner);
  across_ = to_world.vector(plane.across);
  down_ = to_world.vector(plane.down);
}

SensorRay PerspectiveSensor::sample_ray(const Vec2& film, const Vec2&) const {
  const Vec3 towards = corner_ + across_ * film.x + down_ * film.y;
  const float scale = length(towards);  // distance along the ray for one unit along the axis
  return {{origin_, towards / scale, clip_.far_clip * scale}, clip_.near_clip * scale};
}

std::optional<SensorConnection> PerspectiveSensor::connect(const Vec3& p, const Vec2& u_aperture) const {
  const float distance = length(p - origin_);
  return at_distance(connect_to_infinity((p - origin_) / distance, u_aperture), distance);
}

std::optional<SensorConnection> PerspectiveSensor::connect_to_infinity(const Vec3& direction, const Vec2&) const {
  auto result = connect_through({corner_, across_, down_}, clip_, direction);
  if (result) result->position = origin_;
  return result;
}

}  // namespace turbid
