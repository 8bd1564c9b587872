#pragma once
#include "core/transform.h"
#include "geometry/shape.h"

namespace turbid {

/// Mitsuba's `disk`: the unit disk in the xy plane, normal +z, mapped by `to_world`, which may scale x and y
/// differently but must not shear (else std::invalid_argument). uv = (radius, azimuth/(2 pi)).
class Disk final : public Shape {
 public:
  explicit Disk(const Transform& to_world = {}, bool flip_normals = false);

  Bounds3 bounds() const override;
  float area() const override;
  bool is_closed() const override { return false; }
  SurfacePoint surface_point(const Ray& ray, const Hit& hit) const override;
  AreaSample sample_area(const Vec2& u) const override;
  RTCGeometry make_embree_geometry(RTCDevice device) const override;
  float distance_bound(const Vec3& p, uint32_t primitive) const override;

  /// Distance along the ray to the disk with t > 0, or infinity.
  double intersect(const Vec3& origin, const Vec3& direction) const;
  /// Normal on the outside, at a point of the disk.
  Vec3 normal_at(const Imath::V3d& p) const;

 private:
  SurfacePoint point_at(double x, double y) const;

  Imath::V3d center_, x_axis_, y_axis_, normal_;  ///< unit axes, world space
  double x_radius_, y_radius_;
};

}  // namespace turbid
