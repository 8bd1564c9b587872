#pragma once
#include "core/transform.h"
#include "sensor/clip_range.h"
#include "sensor/sensor.h"

namespace turbid {

/// The film of a perspective sensor seen through its pinhole, on the plane z = 1 of the sensor's space: film
/// coordinates (x, y) lie at corner + x across + y down.
struct FilmPlane {
  Vec3 corner, across, down;
};

/// What a perspective sensor sees in `direction` (unit, away from the sensor) through the point of its aperture that
/// lies `offset` beside the pinhole; everything sharp at depth focus_distance. The plane is given in world space here.
/// The connection's position is left to the caller. Empty behind the sensor.
std::optional<SensorConnection> connect_through(const FilmPlane& plane, const ClipRange& clip, const Vec3& direction,
                                                const Vec3& offset = Vec3(0), float focus_distance = kInfinity);

/// Turns a connection to infinity into one with a point at `distance` in the same direction; empty where it is clipped.
std::optional<SensorConnection> at_distance(std::optional<SensorConnection> connection, float distance);

/// Throws std::invalid_argument unless 0 < x_fov < 180 (degrees) and aspect > 0.
FilmPlane film_plane(double x_fov, double aspect, const Vec2& principal_point_offset);

/// Throws std::invalid_argument when the transform changes lengths, as Mitsuba does for perspective sensors.
void check_rigid(const Transform& to_world);

}  // namespace turbid
