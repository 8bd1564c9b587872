#pragma once
#include "core/transform.h"
#include "geometry/shape.h"

namespace turbid {

/// Mitsuba's `cylinder`: an open tube of the given radius around the line from p0 to p1, without caps, mapped by
/// `to_world`, which must keep it a circular cylinder (else std::invalid_argument). uv = (azimuth/(2 pi), position from
/// p0 to p1).
class Cylinder final : public Shape {
 public:
  Cylinder(const Vec3& p0, const Vec3& p1, float radius, const Transform& to_world = {}, bool flip_normals = false);

  Bounds3 bounds() const override;
  float area() const override;
  bool is_closed() const override { return false; }
  SurfacePoint surface_point(const Ray& ray, const Hit& hit) const override;
  AreaSample sample_area(const Vec2& u) const override;
  RTCGeometry make_embree_geometry(RTCDevice device) const override;
  float distance_bound(const Vec3& p, uint32_t primitive) const override;

  /// Distance along the ray to the first crossing with t > 0, or infinity.
  double intersect(const Vec3& origin, const Vec3& direction) const;
  /// Normal on the outside, at a point of the cylinder.
  Vec3 normal_at(const Imath::V3d& p) const;

 private:
  SurfacePoint point_at(double cos_phi, double sin_phi, double z) const;

  Imath::V3d base_, x_axis_, y_axis_, z_axis_;  ///< unit axes, world space; z from p0 to p1
  double radius_, length_;
  bool flip_normals_;
};

}  // namespace turbid
