#pragma once
#include <embree3/rtcore.h>

#include <functional>

#include "geometry/embree_ray.h"

namespace turbid {

/// Finds, among many boxes, those that a piece of a ray may come through or a point may lie in: a bounding-volume
/// hierarchy by Embree whose leaves are handed out instead of intersected. Every box touched is reported once, in no
/// order. Queries are const and thread-safe.
class VolumeIndex {
 public:
  VolumeIndex();
  ~VolumeIndex();
  VolumeIndex(const VolumeIndex&) = delete;
  VolumeIndex& operator=(const VolumeIndex&) = delete;

  /// Takes the place of what was there. `box(i)` is called from several threads.
  void build(size_t count, const std::function<Bounds3(size_t)>& box);
  bool empty() const { return count_ == 0; }

  /// Calls visit(number) for boxes along the ray in [0, t_max].
  template <class Visit>
  void along(const Ray& ray, const Visit& visit) const {
    if (empty()) return;
    Query query{{}, &visit, call<Visit>};
    rtcInitIntersectContext(&query.context);
    alignas(16) RTCRay cast = embree_ray(ray, ray.t_max);
    rtcOccluded1(scene_, &query.context, &cast);
  }

  /// Calls visit(number) for boxes around a point.
  template <class Visit>
  void around(const Vec3& p, const Visit& visit) const {
    if (empty()) return;
    alignas(16) RTCPointQuery query{p.x, p.y, p.z, 0, 0};
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    rtcPointQuery(
        scene_, &query, &context,
        [](RTCPointQueryFunctionArguments* args) {
          (*static_cast<const Visit*>(args->userPtr))(args->primID);
          return false;
        },
        const_cast<Visit*>(&visit));  // only ever read back as const
  }

 private:
  /// What the callback of a ray finds behind Embree's context.
  struct Query {
    RTCIntersectContext context;
    const void* visit;
    void (*call)(const void* visit, uint32_t number);
  };
  template <class Visit>
  static void call(const void* visit, uint32_t number) {
    (*static_cast<const Visit*>(visit))(number);
  }

  RTCDevice device_;
  RTCScene scene_ = nullptr;
  size_t count_ = 0;
};

}  // namespace turbid
