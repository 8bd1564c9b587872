#include "geometry/instance.h"

#include <stdexcept>

#include "geometry/affine.h"
#include "geometry/shading_frame.h"
#include "geometry/triangle_mesh.h"

namespace turbid {
using Imath::V3d;
GroupPlacement::GroupPlacement(std::shared_ptr<const ShapeGroup> group, const Transform& to_world)
    : group_(std::move(group)), to_world_(to_world), to_group_(to_world.inverse()) {
  constexpr double kSafely = 1 - 1e-6;  // rounding must not raise it
  least_stretch_ = static_cast<float>(kSafely * turbid::least_stretch(to_world));
  if (!(least_stretch_ > 0) || !std::isfinite(1 / least_stretch_))
    throw std::invalid_argument("instance: to_world must be affine and not flatten what it places");
}

float GroupPlacement::local_error(const Vec3& local) const {
  constexpr float kRoundings = 2;  // one of the result, and the few of double precision on the way
  return kRoundings * rounding_error(local);
}

Bounds3 GroupPlacement::world_bounds(const Bounds3& local) const {
  Bounds3 result;
  if (local.isEmpty()) return result;
  for (int corner = 0; corner < 8; ++corner)
    result.extendBy(to_world_.point({corner & 1 ? local.max.x : local.min.x, corner & 2 ? local.max.y : local.min.y,
                                     corner & 4 ? local.max.z : local.min.z}));
  return result;
}

Bounds3 GroupPlacement::bounds() const {
  Bounds3 result;
  for (const auto& member : group_->members) result.extendBy(world_bounds(member->bounds()));
  return result;
}

ShapeInstance::ShapeInstance(std::shared_ptr<const GroupPlacement> placement, uint32_t member)
    : placement_(std::move(placement)),
      member_(placement_->group().members.at(member).get()),
      mesh_(dynamic_cast<const TriangleMesh*>(member_)),
      index_(member) {}

double ShapeInstance::area_stretch(const Vec3& local_normal) const {
  const Transform& m = placement_->to_world();
  const V3d x = linear_column(m, 0), y = linear_column(m, 1), z = linear_column(m, 2), n(local_normal);
  return (y.cross(z) * n.x + z.cross(x) * n.y + x.cross(y) * n.z).length();  // the cofactors times n
}

float ShapeInstance::area() const {
  if (const double scale = placement_->to_world().uniform_scale(); scale > 0)
    return static_cast<float>(scale * scale * static_cast<double>(member_->area()));
  double sum = 0;
  if (mesh_ != nullptr) {
    const MeshData& mesh = mesh_->data();
    const auto corner = [&](size_t i) {
      return map_vector(placement_->to_world(), V3d(mesh.positions[mesh.indices[i]]));
    };
    for (size_t i = 0; i < mesh.indices.size(); i += 3) {
      const V3d a = corner(i);
      sum += (corner(i + 1) - a).cross(corner(i + 2) - a).length() / 2;
    }
    return static_cast<float>(sum);
  }
  constexpr int kSteps = 64;
  for (int i = 0; i < kSteps; ++i)
    for (int j = 0; j < kSteps; ++j) {
      const Vec2 u((static_cast<float>(i) + 0.5f) / kSteps, (static_cast<float>(j) + 0.5f) / kSteps);
      sum += area_stretch(member_->sample_area(u).point.ng);
    }
  return static_cast<float>(sum / (kSteps * kSteps) * static_cast<double>(member_->area()));
}

float ShapeInstance::extra_error(const Vec3& local, const Vec3& world) const {
  constexpr float kRoundings = 3;  // of the point, of its move off the surface, and to spare
  return placement_->local_error(local) + kRoundings * rounding_error(world) / placement_->least_stretch();
}

SurfacePoint ShapeInstance::place(const SurfacePoint& local, float extra_error) const {
  const Transform& m = placement_->to_world();
  // A triangle must know of the extra error: it keeps points off its edges.
  SurfacePoint s = mesh_ ? mesh_->point_on_triangle(local.primitive, local.barycentric, extra_error) : local;
  if (mesh_ == nullptr) s.error += extra_error;
  s.p = m.point(s.p);
  // A step h along the world's unit normal moves by h |M^-T n| along the group's unit normal n.
  const Vec3 normal = m.normal(s.ng);
  const float norm = length(normal);
  s.error /= norm;
  s.ng = normal * (1 / norm);
  s.dp_du = m.vector(s.dp_du);
  s.dp_dv = m.vector(s.dp_dv);
  s.shading = shading_frame(bend_to_front(m.normal(s.shading.n), s.ng), s.dp_du);
  return s;
}

SurfacePoint ShapeInstance::surface_point(const Ray& ray, const Hit& hit) const {
  const Ray local{placement_->local_point(ray.origin), placement_->local_direction(ray.direction), hit.t};
  SurfacePoint at;
  if (mesh_ != nullptr) {
    at.primitive = hit.primitive;
    at.barycentric = hit.barycentric;
  } else {
    at = member_->surface_point(local, hit);
  }
  return place(
      at, extra_error(abs(local.origin) + abs(local.direction) * hit.t, abs(ray.origin) + abs(ray.direction) * hit.t));
}

AreaSample ShapeInstance::sample_area(const Vec2& u) const {
  const AreaSample local = member_->sample_area(u);
  return {place(local.point, extra_error(local.point.p, placement_->to_world().point(local.point.p))),
          static_cast<float>(static_cast<double>(local.pdf_a) / area_stretch(local.point.ng))};
}

RTCGeometry ShapeInstance::make_embree_geometry(RTCDevice) const {
  throw std::logic_error("instances are built by their group");
}

float ShapeInstance::distance_bound(const Vec3& p, uint32_t primitive) const {
  const Vec3 local = placement_->local_point(p);
  const float bound = member_->distance_bound(local, primitive) - placement_->local_error(local);
  return std::max(0.0f, bound * placement_->least_stretch() * (1 - 4 * kUnitRoundoff));
}

std::vector<std::shared_ptr<const Shape>> place_group(std::shared_ptr<const ShapeGroup> group,
                                                      const Transform& to_world) {
  const auto placement = std::make_shared<const GroupPlacement>(std::move(group), to_world);
  std::vector<std::shared_ptr<const Shape>> shapes;
  for (uint32_t i = 0; i < placement->group().members.size(); ++i)
    shapes.push_back(std::make_shared<ShapeInstance>(placement, i));
  return shapes;
}

}  // namespace turbid
