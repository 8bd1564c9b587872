#pragma once
#include <Imath/ImathVec.h>

#include "geometry/mesh_data.h"

namespace turbid {

/// True when every edge is used as often in the one direction as in the other, so that the surface has no rim. Vertices
/// at equal positions are one. O(n) memory, O(n log n) time.
bool edges_are_paired(const MeshData& mesh);

/// Distance from the origin to the triangle a, b, c.
double distance_to_triangle(const Imath::V3d& a, const Imath::V3d& b, const Imath::V3d& c);

}  // namespace turbid
