#pragma once
#include "photon/photon_gatherer.h"

namespace turbid {

/// Radii of disks on surfaces, scene units: `pixels` widths of what a pixel covers where the sensor looks, and smaller
/// where disks reach past edges: no more than half a percent of those around what the sensor sees may be empty, which
/// is what merging loses there of even light.
float default_surface_radius(const Scene& scene, float pixels);
/// Radii of kernels in media, `surface` left out: by what a pixel covers, too, and no more than a share of the mean
/// free path: a kernel that reaches past the boundary of a medium loses light there: of what is scattered once or twice
/// about 0.6 radius / mean free path (docs/photons.md).
KernelRadii default_media_radii(const Scene& scene, float pixels);

}  // namespace turbid
