#include "geometry/cylinder.h"

#include <limits>
#include <stdexcept>

#include "geometry/affine.h"
#include "geometry/azimuth.h"
#include "geometry/shading_frame.h"
#include "geometry/user_geometry.h"

namespace turbid {
using Imath::V3d;

Cylinder::Cylinder(const Vec3& p0, const Vec3& p1, float radius, const Transform& to_world, bool flip_normals)
    : flip_normals_(flip_normals) {
  if (!(radius > 0) || !std::isfinite(radius))
    throw std::invalid_argument("cylinder: the radius must be positive and finite");
  const V3d line = V3d(p1) - V3d(p0);
  if (!(line.length() > 0) || !std::isfinite(line.length()))
    throw std::invalid_argument("cylinder: p0 and p1 must be finite and differ");
  const Frame frame{Vec3(line.normalized())};
  const auto r = static_cast<double>(radius);
  const V3d x = map_vector(to_world, V3d(frame.s) * r), y = map_vector(to_world, V3d(frame.t) * r),
            z = map_vector(to_world, line);
  radius_ = x.length();
  length_ = z.length();
  constexpr double kTolerance = 1e-5;  // rounding of decimal matrices in scene files
  const bool circular =
      std::abs(y.length() - radius_) <= kTolerance * radius_ && std::abs(x.dot(y)) <= kTolerance * radius_ * radius_ &&
      std::abs(x.dot(z)) <= kTolerance * radius_ * length_ && std::abs(y.dot(z)) <= kTolerance * radius_ * length_;
  if (!circular) throw std::invalid_argument("cylinder: to_world must keep it circular and upright on its axis");
  base_ = translation(to_world) + map_vector(to_world, V3d(p0));
  z_axis_ = z * (1 / length_);
  x_axis_ = (x - z_axis_ * x.dot(z_axis_)).normalized();
  y_axis_ = z_axis_.cross(x_axis_);
  if (y_axis_.dot(y) < 0) y_axis_ = -y_axis_;
}

Bounds3 Cylinder::bounds() const {
  const V3d top = base_ + z_axis_ * length_;
  V3d half;
  for (int i = 0; i < 3; ++i) half[i] = radius_ * std::sqrt(x_axis_[i] * x_axis_[i] + y_axis_[i] * y_axis_[i]);
  Bounds3 bounds{Vec3(base_ - half), Vec3(base_ + half)};
  bounds.extendBy(Bounds3{Vec3(top - half), Vec3(top + half)});
  return bounds;
}

float Cylinder::area() const { return static_cast<float>(2 * std::numbers::pi * radius_ * length_); }

double Cylinder::intersect(const Vec3& origin, const Vec3& direction) const {
  constexpr double kMiss = std::numeric_limits<double>::infinity();
  const V3d o = V3d(origin) - base_, d(direction);
  const double ox = o.dot(x_axis_), oy = o.dot(y_axis_), oz = o.dot(z_axis_);
  const double dx = d.dot(x_axis_), dy = d.dot(y_axis_), dz = d.dot(z_axis_);
  // a t^2 + 2 b t + c = 0 in the plane across the axis; the sign of c tells the side that the origin is on.
  const double a = dx * dx + dy * dy, b = ox * dx + oy * dy, c = ox * ox + oy * oy - radius_ * radius_;
  const double discriminant = b * b - a * c;
  if (!(a > 0) || (c > 0 && (b >= 0 || discriminant < 0))) return kMiss;
  const double root = std::sqrt(std::max(discriminant, 0.0));
  const auto on_tube = [&](double t) {
    const double z = oz + dz * t;
    return t > 0 && z >= 0 && z <= length_;
  };
  if (c > 0) {
    const double near_t = c / (root - b);
    if (on_tube(near_t)) return near_t;
  }
  const double far_t = b > 0 ? -c / (b + root) : (root - b) / a;
  return on_tube(far_t) ? far_t : kMiss;
}

Vec3 Cylinder::normal_at(const V3d& p) const {
  const V3d v = p - base_;
  const V3d n = (x_axis_ * v.dot(x_axis_) + y_axis_ * v.dot(y_axis_)).normalized();
  return Vec3(flip_normals_ ? -n : n);
}

SurfacePoint Cylinder::point_at(double cos_phi, double sin_phi, double z) const {
  const V3d n = x_axis_ * cos_phi + y_axis_ * sin_phi;

  SurfacePoint s;
  s.p = Vec3(base_ + n * radius_ + z_axis_ * z);
  s.error = rounding_error(s.p);
  s.ng = Vec3(flip_normals_ ? -n : n);
  s.uv = {turn_of(static_cast<float>(cos_phi), static_cast<float>(sin_phi)), static_cast<float>(z / length_)};
  s.dp_du = Vec3((y_axis_ * cos_phi - x_axis_ * sin_phi) * (2 * std::numbers::pi * radius_));
  s.dp_dv = Vec3(z_axis_ * length_);
  s.shading = shading_frame(s.ng, s.dp_du);
  return s;
}

SurfacePoint Cylinder::surface_point(const Ray& ray, const Hit& hit) const {
  const V3d p = V3d(ray.origin) + V3d(ray.direction) * static_cast<double>(hit.t) - base_;
  const double x = p.dot(x_axis_), y = p.dot(y_axis_), rho = std::sqrt(x * x + y * y);
  return point_at(x / rho, y / rho, p.dot(z_axis_));
}

AreaSample Cylinder::sample_area(const Vec2& u) const {
  const double phi = 2 * std::numbers::pi * static_cast<double>(u.y);
  return {point_at(std::cos(phi), std::sin(phi), static_cast<double>(u.x) * length_), 1 / area()};
}

RTCGeometry Cylinder::make_embree_geometry(RTCDevice device) const { return make_user_geometry(device, this); }

float Cylinder::distance_bound(const Vec3& p, uint32_t) const {
  const V3d v = V3d(p) - base_;
  const double z = v.dot(z_axis_), rho = std::hypot(v.dot(x_axis_), v.dot(y_axis_));
  const double beyond = std::max({0.0, -z, z - length_});
  return static_cast<float>(std::hypot(rho - radius_, beyond) * (1 - 1e-7));
}

}  // namespace turbid
