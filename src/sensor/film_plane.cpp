#include "sensor/film_plane.h"

#include <stdexcept>

namespace turbid {

FilmPlane film_plane(double x_fov, double aspect, const Vec2& principal_point_offset) {
  if (!(x_fov > 0 && x_fov < 180))
    throw std::invalid_argument("the horizontal field of view must lie between 0 and 180 degrees, both excluded");
  if (!(aspect > 0)) throw std::invalid_argument("the aspect of a film must be positive");
  const double half_width = std::tan(x_fov * std::numbers::pi / 360);
  const auto x = static_cast<float>(half_width), y = static_cast<float>(half_width / aspect);
  const Vec3 across(-2 * x, 0, 0), down(0, -2 * y, 0);
  return {Vec3(x, y, 1) + across * principal_point_offset.x + down * principal_point_offset.y, across, down};
}

std::optional<SensorConnection> connect_through(const FilmPlane& plane, const ClipRange& clip, const Vec3& direction,
                                                const Vec3& offset, float focus_distance) {
  const Vec3 normal = cross(plane.across, plane.down);
  const float area = length(normal);
  // The corner lies at depth 1, and so tells which side of the plane is the front.
  const Vec3 axis = normal * ((dot(normal, plane.corner) > 0 ? 1 : -1) / area);
  const float cosine = dot(direction, axis);
  if (!(cosine > 0)) return std::nullopt;
  const Vec3 on_plane = direction / cosine + offset / focus_distance - plane.corner;
  SensorConnection result;
  result.film = {dot(on_plane, plane.across) / length_squared(plane.across),
                 dot(on_plane, plane.down) / length_squared(plane.down)};
  result.importance = 1 / (area * cosine * cosine * cosine);
  result.near_t = clip.near_clip / cosine;
  result.far_t = clip.far_clip / cosine;
  return result;
}

std::optional<SensorConnection> at_distance(std::optional<SensorConnection> connection, float distance) {
  if (!connection || !(distance > connection->near_t && distance < connection->far_t)) return std::nullopt;
  connection->importance /= sqr(distance);
  return connection;
}

void check_rigid(const Transform& to_world) {
  constexpr double kTolerance = 1e-3;  // decimal matrices in scene files
  if (!(std::abs(to_world.uniform_scale() - 1) < kTolerance))
    throw std::invalid_argument("the to_world transform of a perspective sensor must not scale or shear");
}

}  // namespace turbid
