#include "sensor/orthographic.h"

#include <stdexcept>

namespace turbid {

OrthographicSensor::OrthographicSensor(const Transform& to_world, double aspect, const ClipRange& clip) {
  check(clip);
  if (!(aspect > 0)) throw std::invalid_argument("the aspect of a film must be positive");
  const auto y = static_cast<float>(1 / aspect);
  corner_ = to_world.point(Vec3(1, y, 0));
  across_ = to_world.vector(Vec3(-2, 0, 0));
  down_ = to_world.vector(Vec3(0, -2 * y, 0));
  const Vec3 axis = to_world.vector(Vec3(0, 0, 1));
  direction_ = normalize(axis);
  near_t_ = clip.near_clip * length(axis);
  far_t_ = clip.far_clip * length(axis);
}

SensorRay OrthographicSensor::sample_ray(const Vec2& film, const Vec2&) const {
  return {{corner_ + across_ * film.x + down_ * film.y, direction_, far_t_}, near_t_};
}

std::optional<SensorConnection> OrthographicSensor::connect(const Vec3& p, const Vec2&) const {
  // p = corner + x across + y down + t direction; to_world may shear, so nothing need be perpendicular.
  const Vec3 from_corner = p - corner_;
  const float volume = dot(cross(across_, down_), direction_);
  const float x = dot(cross(from_corner, down_), direction_) / volume;
  const float y = dot(cross(across_, from_corner), direction_) / volume;
  const Vec3 position = corner_ + across_ * x + down_ * y;
  const float t = dot(p - position, direction_);
  if (!(t > near_t_ && t < far_t_)) return std::nullopt;
  return SensorConnection{position, {x, y}, 1 / std::abs(volume), near_t_, far_t_};
}

}  // namespace turbid
