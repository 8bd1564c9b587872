#pragma once
#include "core/transform.h"

namespace turbid {

/// The film of a perspective sensor seen through its pinhole, on the plane z = 1 of the sensor's space: film
/// coordinates (x, y) lie at corner + x across + y down.
struct FilmPlane {
  Vec3 corner, across, down;
};

/// Throws std::invalid_argument unless 0 < x_fov < 180 (degrees) and aspect > 0.
FilmPlane film_plane(double x_fov, double aspect, const Vec2& principal_point_offset);

/// Throws std::invalid_argument when the transform changes lengths, as Mitsuba does for perspective sensors.
void check_rigid(const Transform& to_world);

}  // namespace turbid
