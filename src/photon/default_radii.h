#pragma once
#include "scene/scene.h"

namespace turbid {

/// Radii for kernels, scene units, from what a pixel covers where the sensor looks (`pixels` widths of it).
float default_surface_radius(const Scene& scene, float pixels);
/// In media also no more than a share of the shortest mean free path: a kernel that reaches past the boundary of a medium
/// loses light there, about 0.3 radius / mean free path of it.
float default_media_radius(const Scene& scene, float pixels);

}  // namespace turbid
