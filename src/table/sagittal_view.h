#pragma once
#include "table/lanes.h"

namespace turbid {

/// Where light of an axially symmetric source is looked at, in the frame that its lobes are stored in: of one place, or
/// of eight.
template <class Real, class Vector>
struct BasicSagittalView {
  Real distance;     ///< from the source
  Real cosine;       ///< of the angle between the source's axis and the position
  Vector direction;  ///< of the light: z along the line from the source, x in the plane of the axis, away from it

  /// x: from the source to the place. axis, w: unit vectors. On the axis itself the sagittal plane is undefined and the
  /// direction's x is 0.
  BasicSagittalView(const Vector& x, const Vector& axis, const Vector& w) {
    using std::sqrt, std::copysign, std::experimental::sqrt, std::experimental::copysign, std::experimental::where;
    distance = sqrt(dot(x, x));
    const Real inverse = 1 / distance;
    Real along_axis = dot(x, axis) * inverse, along = dot(w, x) * inverse;
    const auto at_source = !(distance > 0);
    where(at_source, along_axis) = Real(1.0f);
    where(at_source, along) = dot(w, axis);
    cosine = clamped(along_axis, -1, 1);
    along = clamped(along, -1, 1);
    const Real across_squared = 1 - along * along;
    const Real sine_squared = 1 - cosine * cosine;
    Real in_plane = (cosine * along - dot(w, axis)) / sqrt(sine_squared);
    where(!(sine_squared > 1e-9f), in_plane) = Real(0.0f);
    const Real off_plane = across_squared - in_plane * in_plane;
    where(off_plane < 0, in_plane) = copysign(safe_sqrt(across_squared), in_plane);
    direction = {in_plane, safe_sqrt(off_plane), along};
  }
};

using SagittalView = BasicSagittalView<float, Vec3>;
using SagittalViewLanes = BasicSagittalView<Lanes, Vec3Lanes>;

}  // namespace turbid
