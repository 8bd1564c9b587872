#pragma once
#include <Imath/ImathVec.h>

#include "core/transform.h"

namespace turbid {

/// Column of the linear part of an affine map, in double: the image of the axis `column` (0, 1, 2).
inline Imath::V3d linear_column(const Transform& m, int column) {
  return {m.at(0, column), m.at(1, column), m.at(2, column)};
}
/// The image of the origin.
inline Imath::V3d translation(const Transform& m) { return linear_column(m, 3); }
/// The image of a vector, in double.
inline Imath::V3d map_vector(const Transform& m, const Imath::V3d& v) {
  return linear_column(m, 0) * v.x + linear_column(m, 1) * v.y + linear_column(m, 2) * v.z;
}

/// The least length that a unit vector is mapped to (the least singular value); 0 when the map is not affine.
double least_stretch(const Transform& m);

}  // namespace turbid
