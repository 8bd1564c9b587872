#include "geometry/sphere.h"

#include <stdexcept>

#include "core/warp.h"
#include "geometry/affine.h"
#include "geometry/azimuth.h"
#include "geometry/shading_frame.h"
#include "geometry/user_geometry.h"

namespace turbid {
using Imath::V3d;
namespace {
/// The cone that a sphere of radius r fills, seen from distance d > r: 1 - cos of its half angle, without cancellation.
double one_minus_cos_cone(double r, double d_squared) {
  const double sin_squared = r * r / d_squared;
  return sin_squared / (1 + std::sqrt(std::max(0.0, 1 - sin_squared)));
}
}  // namespace

Sphere::Sphere(const Vec3& center, float radius, const Transform& to_world, bool flip_normals)
    : center_(to_world.point(center)), flip_normals_(flip_normals) {
  const double scale = to_world.uniform_scale();
  if (!(scale > 0))
    throw std::invalid_argument("sphere: to_world must be a rotation, translation and uniform scale only");
  radius_ = static_cast<float>(static_cast<double>(radius) * scale);
  if (!(radius_ > 0) || !std::isfinite(radius_))
    throw std::invalid_argument("sphere: the radius must be positive and finite");
  if (!std::isfinite(center_.x + center_.y + center_.z))
    throw std::invalid_argument("sphere: the center must be finite");
  for (int i = 0; i < 3; ++i) axes_[i] = linear_column(to_world, i) * (1 / scale);
}

Bounds3 Sphere::bounds() const { return {center_ - Vec3(radius_), center_ + Vec3(radius_)}; }

Vec3 Sphere::normal_at(const V3d& p) const {
  const V3d n = (p - V3d(center_)).normalized();
  return Vec3(flip_normals_ ? -n : n);
}

SurfacePoint Sphere::point_at(const V3d& n) const {
  const Vec3 local(V3d(n.dot(axes_[0]), n.dot(axes_[1]), n.dot(axes_[2])));
  const float rho = std::sqrt(local.x * local.x + local.y * local.y);
  const float cos_phi = rho > 0 ? local.x / rho : 1, sin_phi = rho > 0 ? local.y / rho : 0;
  const Vec3 x(axes_[0]), y(axes_[1]), z(axes_[2]);

  SurfacePoint s;
  s.p = Vec3(V3d(center_) + n * static_cast<double>(radius_));
  s.error = rounding_error(s.p);
  s.ng = Vec3(flip_normals_ ? -n : n);
  s.uv = {turn_of(local.x, local.y), 2 * turn_of(local.z, rho)};
  s.dp_du = (y * local.x - x * local.y) * (2 * kPi * radius_);
  s.dp_dv = ((x * cos_phi + y * sin_phi) * local.z - z * rho) * (kPi * radius_);
  s.shading = shading_frame(s.ng, s.dp_du);
  return s;
}

SurfacePoint Sphere::surface_point(const Ray& ray, const Hit& hit) const {
  const V3d p = V3d(ray.origin) + V3d(ray.direction) * static_cast<double>(hit.t);
  return point_at((p - V3d(center_)).normalized());
}

AreaSample Sphere::sample_area(const Vec2& u) const {
  return {point_at(V3d(square_to_sphere(u)).normalized()), 1 / area()};
}

std::optional<Shape::DirectSample> Sphere::sample_direct(const Vec3& from, const Vec2& u) const {
  const V3d to_center = V3d(center_) - V3d(from);
  const auto r = static_cast<double>(radius_);
  const double d_squared = to_center.length2();
  if (d_squared <= r * r) return Shape::sample_direct(from, u);

  const double d = std::sqrt(d_squared), solid = one_minus_cos_cone(r, d_squared);
  const double one_minus_cos = static_cast<double>(u.y) * solid, cosine = 1 - one_minus_cos;
  const double sin_squared = one_minus_cos * (1 + cosine), sine = std::sqrt(sin_squared);
  const double phi = 2 * std::numbers::pi * static_cast<double>(u.x);
  const V3d axis = to_center * (1 / d);
  const Frame frame{Vec3(axis)};
  const V3d direction = V3d(frame.s) * (sine * std::cos(phi)) + V3d(frame.t) * (sine * std::sin(phi)) + axis * cosine;
  // Distance to the near side along a ray at that angle to the axis.
  const double half_chord = std::sqrt(std::max(0.0, r * r - d_squared * sin_squared));
  const double t = d * cosine - half_chord;
  return DirectSample{point_at((direction * t - to_center).normalized()),
                      static_cast<float>(1 / (2 * std::numbers::pi * solid))};
}

float Sphere::pdf_direct_w(const Vec3& from, const Vec3& p, const Vec3& ng) const {
  const auto r = static_cast<double>(radius_);
  const double d_squared = (V3d(center_) - V3d(from)).length2();
  if (d_squared <= r * r) return Shape::pdf_direct_w(from, p, ng);
  return static_cast<float>(1 / (2 * std::numbers::pi * one_minus_cos_cone(r, d_squared)));
}

RTCGeometry Sphere::make_embree_geometry(RTCDevice device) const { return make_user_geometry(device, this); }

float Sphere::distance_bound(const Vec3& p, uint32_t) const {
  const double d = std::abs((V3d(p) - V3d(center_)).length() - static_cast<double>(radius_));
  return static_cast<float>(d * (1 - 1e-7));  // the rounding to float must not raise it
}

}  // namespace turbid
