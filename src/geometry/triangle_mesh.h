#pragma once
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "core/distribution.h"
#include "geometry/mesh_data.h"
#include "geometry/shape.h"

namespace turbid {

/// Triangles with shared vertices, in world space. The winding tells the outside; vertex normals only shade.
///
/// Where the vertex normals of most of the area oppose the winding, one of them must be wrong (Mitsuba 3 then takes the
/// one for media and the other for BSDFs and emission). A warning is given, and: a closed mesh is oriented so that its
/// outside is outside; an open one, which cannot bound a medium, follows its vertex normals.
class TriangleMesh final : public Shape {
 public:
  /// Throws std::invalid_argument when the arrays do not fit together, an index is out of range, a position is not
  /// finite or no proper triangle remains. Triangles without area are dropped with a warning that counts them; normals
  /// that are zero or not finite are replaced by the face's where they are needed.
  explicit TriangleMesh(MeshData data, bool flip_normals = false);

  const std::string& name() const { return mesh_.name; }
  const MeshData& data() const { return mesh_; }
  size_t triangle_count() const { return mesh_.triangle_count(); }
  size_t vertex_count() const { return mesh_.positions.size(); }
  bool has_vertex_normals() const { return !mesh_.normals.empty(); }
  bool has_uvs() const { return !mesh_.uvs.empty(); }
  /// Null when there is none of that name.
  const MeshAttribute* attribute(const std::string& name) const;
  /// The attribute at a point of this mesh; a single channel is repeated.
  Vec3 eval_attribute(const MeshAttribute& attribute, const SurfacePoint& at) const;

  Bounds3 bounds() const override { return bounds_; }
  float area() const override { return static_cast<float>(area_); }
  size_t primitive_count() const override { return triangle_count(); }
  /// Every edge is met by as many triangles in the one direction as in the other; positions count, not indices, so
  /// that seams of normals and uvs are no holes. Found at the first call.
  bool is_closed() const override;
  SurfacePoint surface_point(const Ray& ray, const Hit& hit) const override;
  AreaSample sample_area(const Vec2& u) const override;
  RTCGeometry make_embree_geometry(RTCDevice device) const override;
  float distance_bound(const Vec3& p, uint32_t primitive) const override;

  /// The point with barycentric weights (1 - b.x - b.y, b.x, b.y) of a triangle; points closer to an edge than a few
  /// rounding errors are moved inwards to that distance. `extra_error` is added to the error bound: rounding that
  /// rays from there will suffer elsewhere.
  SurfacePoint point_on_triangle(uint32_t triangle, const Vec2& barycentric, float extra_error = 0) const;

 private:
  void drop_degenerate_triangles();
  void settle_orientation();
  float find_edge_slack() const;

  MeshData mesh_;
  Bounds3 bounds_;
  double area_ = 0;
  /// By so much a watertight ray cast may take a triangle for larger than it is: a few units in the last place of the
  /// longest edge. A ray that skims over an edge must keep that distance, or it meets the back of the next triangle.
  float edge_slack_ = 0;
  // Only some meshes are ever asked for these.
  mutable std::once_flag areas_once_, closed_once_;
  mutable DiscreteDistribution triangle_areas_;
  mutable bool closed_ = false;
};

}  // namespace turbid
