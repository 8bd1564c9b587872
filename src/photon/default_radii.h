#pragma once
#include "scene/scene.h"

namespace turbid {

/// Radii for kernels, scene units, from what a pixel covers where the sensor looks (`pixels` widths of it).
/// On surfaces smaller where disks reach past edges: no more than half a percent of those around what the sensor sees
/// may be empty, which is what merging loses there of even light.
float default_surface_radius(const Scene& scene, float pixels);
/// In media also no more than a share of the shortest mean free path: a kernel that reaches past the boundary of a
/// medium loses light there: of what is scattered once or twice about 0.6 radius / mean free path (docs/photons.md).
float default_media_radius(const Scene& scene, float pixels);

}  // namespace turbid
