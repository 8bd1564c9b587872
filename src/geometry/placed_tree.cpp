#include "geometry/placed_tree.h"

#include "geometry/user_geometry.h"

namespace turbid {
namespace {

/// The ray in the group's space, with the same parameter t.
RTCRay taken_to_group(const GroupPlacement& placement, const RTCRay& ray) {
  const Vec3 o = placement.local_point({ray.org_x, ray.org_y, ray.org_z});
  const Vec3 d = placement.local_direction({ray.dir_x, ray.dir_y, ray.dir_z});
  RTCRay local = ray;
  local.org_x = o.x, local.org_y = o.y, local.org_z = o.z;
  local.dir_x = d.x, local.dir_y = d.y, local.dir_z = d.z;
  return local;
}

void find_bounds(const RTCBoundsFunctionArguments* args) {
  const Bounds3 b = widened(static_cast<const PlacedTree*>(args->geometryUserPtr)->placement->bounds());
  *args->bounds_o = {b.min.x, b.min.y, b.min.z, 0, b.max.x, b.max.y, b.max.z, 0};
}

// The RayCaster casts single rays only: N is 1.
void intersect_members(const RTCIntersectFunctionNArguments* args) {
  if (args->valid[0] == 0) return;
  const auto& tree = *static_cast<const PlacedTree*>(args->geometryUserPtr);
  auto* cast = reinterpret_cast<RTCRayHit*>(args->rayhit);
  alignas(16) RTCRayHit local;
  local.ray = taken_to_group(*tree.placement, cast->ray);
  local.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(tree.members, args->context, &local);
  if (local.hit.geomID == RTC_INVALID_GEOMETRY_ID) return;
  cast->ray.tfar = local.ray.tfar;
  cast->hit = local.hit;
  cast->hit.instID[0] = args->geomID;
}

void occlude_by_members(const RTCOccludedFunctionNArguments* args) {
  if (args->valid[0] == 0) return;
  const auto& tree = *static_cast<const PlacedTree*>(args->geometryUserPtr);
  auto* ray = reinterpret_cast<RTCRay*>(args->ray);
  alignas(16) RTCRay local = taken_to_group(*tree.placement, *ray);
  rtcOccluded1(tree.members, args->context, &local);
  if (local.tfar < 0) ray->tfar = -kInfinity;
}

}  // namespace

RTCGeometry PlacedTree::make_embree_geometry(RTCDevice device) const {
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(geometry, 1);
  rtcSetGeometryUserData(geometry, const_cast<PlacedTree*>(this));  // only ever read back as const
  rtcSetGeometryBoundsFunction(geometry, find_bounds, nullptr);
  rtcSetGeometryIntersectFunction(geometry, intersect_members);
  rtcSetGeometryOccludedFunction(geometry, occlude_by_members);
  rtcCommitGeometry(geometry);
  return geometry;
}

}  // namespace turbid
