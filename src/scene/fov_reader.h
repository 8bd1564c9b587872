#pragma once
#include "scene/properties.h"

namespace turbid {

/// The parameters `fov`, `fov_axis` and `focal_length` of sensors and projectors.
const std::vector<Parameter>& field_of_view_parameters();

/// What they say for a picture with that aspect (width / height): the horizontal field of view, degrees.
double read_horizontal_fov(const Properties& p, double aspect);

}  // namespace turbid
