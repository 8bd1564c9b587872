#include "geometry/surface_point.h"

namespace turbid {
namespace {
/// Moves x away from `offset`'s side by one representable number, so that rounding of the sum cannot undo the offset.
float nudge(float x, float offset) {
  if (offset > 0) return std::nextafter(x, kInfinity);
  if (offset < 0) return std::nextafter(x, -kInfinity);
  return x;
}
}  // namespace

Vec3 SurfacePoint::leave(const Vec3& direction) const {
  const Vec3 offset = ng * (leads_outside(ng, direction) ? error : -error);
  const Vec3 moved = p + offset;
  return {nudge(moved.x, offset.x), nudge(moved.y, offset.y), nudge(moved.z, offset.z)};
}

}  // namespace turbid
