#pragma once
#include <embree3/rtcore.h>

#include <cmath>
#include <limits>

#include "core/vector.h"

namespace turbid {

/// The bounds of a computed shape, a little wider, so that rounding inside Embree cannot cull what lies on them.
inline Bounds3 widened(const Bounds3& bounds) {
  constexpr float kRelative = 4e-7f;  // a few units in the last place
  const Vec3 reach(std::max(std::abs(bounds.min.x), std::abs(bounds.max.x)),
                   std::max(std::abs(bounds.min.y), std::abs(bounds.max.y)),
                   std::max(std::abs(bounds.min.z), std::abs(bounds.max.z)));
  const Vec3 margin = reach * kRelative + Vec3(std::numeric_limits<float>::min());
  return {bounds.min - margin, bounds.max + margin};
}

/// A surface of several primitives takes their number beside the ray.
template <class Surface>
double first_crossing(const Surface& surface, const Vec3& origin, const Vec3& direction, uint32_t primitive) {
  if constexpr (requires { surface.intersect(origin, direction, primitive); })
    return surface.intersect(origin, direction, primitive);
  else
    return surface.intersect(origin, direction);
}
template <class Surface>
Bounds3 primitive_bounds(const Surface& surface, uint32_t primitive) {
  if constexpr (requires { surface.cell_bounds(primitive); })
    return surface.cell_bounds(primitive);
  else
    return surface.bounds();
}

/// An Embree geometry whose primitives `Surface` intersects itself. Surface is a Shape and has
///   double intersect(const Vec3& origin, const Vec3& direction) const;  first t > 0, or infinity
///   Vec3 normal_at(const Imath::V3d& p) const;                          on the outside, of a point that it returned
/// and, when there are several primitives, intersect(..., uint32_t primitive) and cell_bounds(uint32_t primitive).
template <class Surface>
RTCGeometry make_user_geometry(RTCDevice device, const Surface* surface) {
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(surface->primitive_count()));
  rtcSetGeometryUserData(geometry, const_cast<Surface*>(surface));  // only ever read back as const
  rtcSetGeometryBoundsFunction(
      geometry,
      [](const RTCBoundsFunctionArguments* args) {
        const Bounds3 b = widened(primitive_bounds(*static_cast<const Surface*>(args->geometryUserPtr), args->primID));
        *args->bounds_o = {b.min.x, b.min.y, b.min.z, 0, b.max.x, b.max.y, b.max.z, 0};
      },
      nullptr);
  // The RayCaster casts single rays only: N is 1.
  rtcSetGeometryIntersectFunction(geometry, [](const RTCIntersectFunctionNArguments* args) {
    if (args->valid[0] == 0) return;
    const auto* shape = static_cast<const Surface*>(args->geometryUserPtr);
    auto* cast = reinterpret_cast<RTCRayHit*>(args->rayhit);
    const Vec3 origin(cast->ray.org_x, cast->ray.org_y, cast->ray.org_z);
    const Vec3 direction(cast->ray.dir_x, cast->ray.dir_y, cast->ray.dir_z);
    const double t = first_crossing(*shape, origin, direction, args->primID);
    if (!(t < static_cast<double>(cast->ray.tfar))) return;
    const Vec3 normal = shape->normal_at(Imath::V3d(origin) + Imath::V3d(direction) * t);
    cast->ray.tfar = std::max(static_cast<float>(t), std::numeric_limits<float>::min());
    cast->hit = {normal.x, normal.y, normal.z, 0, 0, args->primID, args->geomID, {args->context->instID[0]}};
  });
  rtcSetGeometryOccludedFunction(geometry, [](const RTCOccludedFunctionNArguments* args) {
    if (args->valid[0] == 0) return;
    const auto* shape = static_cast<const Surface*>(args->geometryUserPtr);
    auto* ray = reinterpret_cast<RTCRay*>(args->ray);
    const double t = first_crossing(*shape, {ray->org_x, ray->org_y, ray->org_z}, {ray->dir_x, ray->dir_y, ray->dir_z},
                                    args->primID);
    if (t < static_cast<double>(ray->tfar)) ray->tfar = -kInfinity;
  });
  rtcCommitGeometry(geometry);
  return geometry;
}

}  // namespace turbid
