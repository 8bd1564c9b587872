#pragma once
#include <memory>
#include <vector>

#include "core/transform.h"
#include "geometry/shape.h"

namespace turbid {

class TriangleMesh;

/// Shapes that are seen many times: each in the group's own space, held in memory once however many instances there
/// are.
struct ShapeGroup {
  std::vector<std::shared_ptr<const Shape>> members;
};

/// Where a group stands. The RayCaster finds hits of a placed group by casting the ray, taken to the group's space in
/// double precision, through a hierarchy that all its instances share.
class GroupPlacement {
 public:
  /// Throws std::invalid_argument when the map is not affine.
  GroupPlacement(std::shared_ptr<const ShapeGroup> group, const Transform& to_world);

  const ShapeGroup& group() const { return *group_; }
  const Transform& to_world() const { return to_world_; }

  /// World to group. The direction keeps the ray's parameter and is not a unit vector any more.
  Vec3 local_point(const Vec3& p) const { return to_group_.point(p); }
  Vec3 local_direction(const Vec3& d) const { return to_group_.vector(d); }
  /// Lower bound on (distance in the world) / (distance in the group).
  float least_stretch() const { return least_stretch_; }
  /// How far local_point can be from the exact one by rounding, a length in the group's space.
  float local_error(const Vec3& local) const;
  /// World bounds of a box in the group's space.
  Bounds3 world_bounds(const Bounds3& local) const;
  Bounds3 bounds() const;

 private:
  std::shared_ptr<const ShapeGroup> group_;
  Transform to_world_, to_group_;
  float least_stretch_;
};

/// A member of a placed group, as a shape in world space.
class ShapeInstance final : public Shape {
 public:
  ShapeInstance(std::shared_ptr<const GroupPlacement> placement, uint32_t member);

  const GroupPlacement& placement() const { return *placement_; }
  uint32_t member_index() const { return index_; }

  Bounds3 bounds() const override { return placement_->world_bounds(member_->bounds()); }
  /// Exact for meshes and similarities; else by a quadrature over 64 x 64 points of the member.
  float area() const override;
  size_t primitive_count() const override { return member_->primitive_count(); }
  bool is_closed() const override { return member_->is_closed(); }
  SurfacePoint surface_point(const Ray& ray, const Hit& hit) const override;
  /// Uniform in area when the placement is a similarity; else uniform in the member's own.
  AreaSample sample_area(const Vec2& u) const override;
  /// Instances do not stand in the hierarchy by themselves: throws std::logic_error.
  RTCGeometry make_embree_geometry(RTCDevice device) const override;
  float distance_bound(const Vec3& p, uint32_t primitive) const override;

 private:
  /// A point of the member in world space.
  SurfacePoint place(const SurfacePoint& local, float extra_error) const;
  /// Rounding errors, in the group's space, that the member does not know of: those of the point's place in the world
  /// and of rays that are taken back.
  float extra_error(const Vec3& local, const Vec3& world) const;
  /// World area per area of the member at a point with that normal.
  double area_stretch(const Vec3& local_normal) const;

  std::shared_ptr<const GroupPlacement> placement_;
  const Shape* member_;
  const TriangleMesh* mesh_;  ///< the member, if it is one
  uint32_t index_;
};

/// All members of a placed group, in order: a RayCaster wants them side by side.
std::vector<std::shared_ptr<const Shape>> place_group(std::shared_ptr<const ShapeGroup> group,
                                                      const Transform& to_world);

}  // namespace turbid
