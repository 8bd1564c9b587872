#pragma once

namespace turbid {

/// What a field of view is measured along.
enum class FovAxis { kX, kY, kDiagonal, kSmaller, kLarger };

/// The horizontal field of view of a film with the given aspect (width / height), degrees, from one along another axis.
/// Throws std::invalid_argument unless both lie in (0, 180).
double horizontal_fov(double degrees, FovAxis axis, double aspect);

/// The diagonal field of view (degrees) of a lens of that focal length (mm, > 0) before 35 mm film, 36 mm x 24 mm: what
/// Mitsuba makes of `focal_length`, to be used with FovAxis::kDiagonal.
double diagonal_fov_of_focal_length(double millimetres);

}  // namespace turbid
