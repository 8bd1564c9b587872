#include "geometry/disk.h"

#include <limits>
#include <stdexcept>

#include "core/warp.h"
#include "geometry/affine.h"
#include "geometry/azimuth.h"
#include "geometry/shading_frame.h"
#include "geometry/user_geometry.h"

namespace turbid {
using Imath::V3d;

Disk::Disk(const Transform& to_world, bool flip_normals) : center_(translation(to_world)) {
  const V3d x = linear_column(to_world, 0), y = linear_column(to_world, 1);
  x_radius_ = x.length();
  y_radius_ = y.length();
  if (!(std::abs(x.dot(y)) <= 1e-5 * x_radius_ * y_radius_))
    throw std::invalid_argument("disk: to_world must not shear");
  normal_ = x.cross(y).normalized();
  if (to_world.flips_handedness() != flip_normals) normal_ = -normal_;
  x_axis_ = x * (1 / x_radius_);
  y_axis_ = (y - x_axis_ * y.dot(x_axis_)).normalized();
}

Bounds3 Disk::bounds() const {
  // Half extent of an ellipse along each axis.
  const V3d x = x_axis_ * x_radius_, y = y_axis_ * y_radius_;
  V3d half;
  for (int i = 0; i < 3; ++i) half[i] = std::sqrt(x[i] * x[i] + y[i] * y[i]);
  return {Vec3(center_ - half), Vec3(center_ + half)};
}

float Disk::area() const { return static_cast<float>(std::numbers::pi * x_radius_ * y_radius_); }

double Disk::intersect(const Vec3& origin, const Vec3& direction) const {
  constexpr double kMiss = std::numeric_limits<double>::infinity();
  const V3d o = V3d(origin) - center_, d(direction);
  const double t = -o.dot(normal_) / d.dot(normal_);
  if (!(t > 0) || t == kMiss) return kMiss;
  const V3d p = o + d * t;
  return sqr(p.dot(x_axis_) / x_radius_) + sqr(p.dot(y_axis_) / y_radius_) <= 1 ? t : kMiss;
}

Vec3 Disk::normal_at(const V3d&) const { return Vec3(normal_); }

SurfacePoint Disk::point_at(double x, double y) const {
  const double r = std::sqrt(x * x + y * y);
  const double cos_phi = r > 0 ? x / r : 1, sin_phi = r > 0 ? y / r : 0;
  const V3d x_edge = x_axis_ * x_radius_, y_edge = y_axis_ * y_radius_;

  SurfacePoint s;
  s.p = Vec3(center_ + x_edge * x + y_edge * y);
  s.error = rounding_error(s.p);
  s.ng = Vec3(normal_);
  s.uv = {static_cast<float>(r), turn_of(static_cast<float>(x), static_cast<float>(y))};
  s.dp_du = Vec3(x_edge * cos_phi + y_edge * sin_phi);
  s.dp_dv = Vec3((y_edge * cos_phi - x_edge * sin_phi) * (2 * std::numbers::pi * r));
  s.shading = shading_frame(s.ng, s.dp_du);
  return s;
}

SurfacePoint Disk::surface_point(const Ray& ray, const Hit& hit) const {
  const V3d p = V3d(ray.origin) + V3d(ray.direction) * static_cast<double>(hit.t) - center_;
  return point_at(p.dot(x_axis_) / x_radius_, p.dot(y_axis_) / y_radius_);
}

AreaSample Disk::sample_area(const Vec2& u) const {
  const Vec2 p = square_to_disk(u);
  return {point_at(static_cast<double>(p.x), static_cast<double>(p.y)), 1 / area()};
}

RTCGeometry Disk::make_embree_geometry(RTCDevice device) const { return make_user_geometry(device, this); }

float Disk::distance_bound(const Vec3& p, uint32_t) const {
  const V3d v = V3d(p) - center_;
  const double height = v.dot(normal_);
  const double rho = std::sqrt(std::max(0.0, v.length2() - height * height));
  // An ellipse lies inside the circle of its longer axis.
  const double beyond = std::max(0.0, rho - std::max(x_radius_, y_radius_));
  return static_cast<float>(std::hypot(height, beyond) * (1 - 1e-7));
}

}  // namespace turbid
