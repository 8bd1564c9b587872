#pragma once
#include "geometry/mesh_data.h"

namespace turbid {

/// Mitsuba's `rectangle`: [-1,1]^2 in the xy plane, normal +z, uv = (xy + 1)/2; mapped by `to_world`.
MeshData make_rectangle(const Transform& to_world = {});

/// Mitsuba's `cube`: [-1,1]^3 with a normal and a uv square per face; mapped by `to_world`.
MeshData make_cube(const Transform& to_world = {});

}  // namespace turbid
