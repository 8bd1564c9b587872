#pragma once
#include <limits>

#include "core/transform.h"
#include "geometry/shape.h"

namespace turbid {

/// A sphere: the unit sphere scaled by `radius`, moved to `center` and mapped by `to_world`, which must be a similarity
/// (else std::invalid_argument). uv as Mitsuba: u = azimuth/(2 pi) in the object's frame, v = polar angle from +z / pi.
///
/// Hits are computed in double precision and re-projected, so a ray that left the sphere by SurfacePoint::leave meets
/// it again only where it really does.
class Sphere final : public Shape {
 public:
  Sphere(const Vec3& center, float radius, const Transform& to_world = {}, bool flip_normals = false);

  const Vec3& center() const { return center_; }
  float radius() const { return radius_; }

  Bounds3 bounds() const override;
  float area() const override { return 4 * kPi * sqr(radius_); }
  bool is_closed() const override { return true; }
  SurfacePoint surface_point(const Ray& ray, const Hit& hit) const override;
  AreaSample sample_area(const Vec2& u) const override;
  /// From outside: uniform in the cone that the sphere fills; from inside: uniform in area.
  std::optional<DirectSample> sample_direct(const Vec3& from, const Vec2& u) const override;
  float pdf_direct_w(const Vec3& from, const Vec3& p, const Vec3& ng) const override;
  RTCGeometry make_embree_geometry(RTCDevice device) const override;
  float distance_bound(const Vec3& p, uint32_t primitive) const override;

  /// Distance along the ray to the first crossing with t > 0, or infinity.
  double intersect(const Vec3& origin, const Vec3& direction) const;
  /// Normal on the outside, at a point of the sphere.
  Vec3 normal_at(const Imath::V3d& p) const;

 private:
  SurfacePoint point_at(const Imath::V3d& unit_normal) const;

  Vec3 center_;
  float radius_;
  bool flip_normals_;
  Imath::V3d axes_[3];  ///< of the object's frame, unit, in world space
};

inline double Sphere::intersect(const Vec3& origin, const Vec3& direction) const {
  const double fx = double{origin.x} - double{center_.x}, fy = double{origin.y} - double{center_.y},
               fz = double{origin.z} - double{center_.z};
  const double dx = double{direction.x}, dy = double{direction.y}, dz = double{direction.z};
  // a t^2 + 2 b t + c = 0; the sign of c tells the side that the origin is on.
  const double a = dx * dx + dy * dy + dz * dz, b = fx * dx + fy * dy + fz * dz;
  const double c = fx * fx + fy * fy + fz * fz - sqr(double{radius_});
  const double discriminant = b * b - a * c;
  if (c > 0) {
    if (b >= 0 || discriminant < 0) return std::numeric_limits<double>::infinity();
    return c / (std::sqrt(discriminant) - b);
  }
  const double root = std::sqrt(std::max(discriminant, 0.0));
  const double t = b > 0 ? -c / (b + root) : (root - b) / a;
  return t > 0 ? t : std::numeric_limits<double>::infinity();
}

}  // namespace turbid
