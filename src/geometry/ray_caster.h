#pragma once
#include <memory>
#include <vector>

#include "geometry/shape.h"

namespace turbid {

/// All shapes of a scene in one Embree bounding-volume hierarchy: the nearest hit, occlusion, and free distances.
/// Building is deterministic; queries are const and thread-safe.
class RayCaster {
 public:
  explicit RayCaster(std::vector<std::shared_ptr<const Shape>> shapes);
  ~RayCaster();
  RayCaster(const RayCaster&) = delete;
  RayCaster& operator=(const RayCaster&) = delete;

  /// The nearest hit with 0 < t < ray.t_max, or an empty Hit.
  Hit intersect(const Ray& ray) const;
  /// True when anything lies in 0 < t < ray.t_max.
  bool occluded(const Ray& ray) const;
  /// The radius of a ball around p that no surface enters, at most `limit`: a lower bound, 0 where nothing is known.
  float clearance(const Vec3& p, float limit) const;

  const Shape& shape(uint32_t index) const { return *shapes_[index]; }
  const Bounds3& bounds() const { return bounds_; }

 private:
  std::vector<std::shared_ptr<const Shape>> shapes_;
  Bounds3 bounds_;
  RTCDevice device_ = nullptr;
  RTCScene scene_ = nullptr;
};

}  // namespace turbid
