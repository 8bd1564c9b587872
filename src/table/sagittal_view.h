#pragma once
#include <algorithm>

#include "core/vector.h"

namespace turbid {

/// Where light of an axially symmetric source is looked at, in the frame that its lobes are stored in.
struct SagittalView {
  float distance;  ///< from the source
  float cosine;    ///< of the angle between the source's axis and the position
  Vec3 direction;  ///< of the light: z along the line from the source, x in the plane of the axis, away from it

  /// x: from the source to the place. axis, w: unit vectors. On the axis itself the sagittal plane is undefined and the
  /// direction's x is 0.
  SagittalView(const Vec3& x, const Vec3& axis, const Vec3& w) {
    distance = length(x);
    const Vec3 radial = distance > 0 ? x * (1 / distance) : axis;
    cosine = std::clamp(dot(radial, axis), -1.0f, 1.0f);
    const float along = std::clamp(dot(w, radial), -1.0f, 1.0f);
    const float across_squared = 1 - along * along;
    const float sine_squared = 1 - cosine * cosine;
    float in_plane = 0;
    if (sine_squared > 1e-9f) in_plane = (cosine * along - dot(w, axis)) / std::sqrt(sine_squared);
    const float off_plane = across_squared - in_plane * in_plane;
    if (off_plane < 0) in_plane = std::copysign(safe_sqrt(across_squared), in_plane);
    direction = {in_plane, safe_sqrt(off_plane), along};
  }
};

}  // namespace turbid
