#pragma once
#include <vector>

#include "image/image.h"
#include "table/quadtree_table.h"

namespace turbid {

/// Lobes over the whole sphere of directions, as seen along their optimal axes (S1 Fig. 8). A row for each place: first
/// `computed`, second `sampled`, third the isolines of both, computed in blue, sampled in green.
///
/// A disk is the sphere: the middle is the optimal axis, the rim the direction against it, equal areas are equal solid
/// angles (Lambert). The sagittal plane lies across, angles that turn away from the source's axis to the right; the
/// coronal plane stands upright. Colours: the logarithm of the source radiance, kSphereDecades from black over red to
/// white, which is the largest computed one. Isolines are steps of 2 down from that.
Image plot_spheres(const LightField& computed, const QuadtreeField& sampled, const std::vector<Quadtree::Place>& places,
                   int disk = 200);
inline constexpr float kSphereDecades = 3;

/// What compression alone does to the lobe of a place: `computed` in all of LobeDirections against the curves that
/// SampledLobe makes of it, no cells in between. Root mean square difference over the root mean square.
double compression_error(const LightField& computed, const Quadtree::Place& place, SourceKind kind);

}  // namespace turbid
