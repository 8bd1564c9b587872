#pragma once
#include <array>
#include <vector>

#include "core/transform.h"
#include "geometry/shape.h"

namespace turbid {

/// Samples of a signed distance (any function whose zero is the surface, negative inside) on a grid over the unit cube:
/// sample (i, j, k) stands at (i / (nx - 1), j / (ny - 1), k / (nz - 1)).
struct SdfSamples {
  std::array<int, 3> size{};  ///< nx, ny, nz; at least 2
  std::vector<float> values;  ///< x fastest, z slowest
};

/// Mitsuba's `sdfgrid`: the zero level of the trilinear interpolant of the samples, mapped by `to_world`. Each cell
/// that the level passes is a primitive; along a ray the interpolant is a cubic, whose first change of sign is the hit
/// (Hansson-Soderlund 2022). Cells agree on the sign where they meet, so a ray never slips through between them. It has
/// no uvs, is not sampled and so cannot shine.
class SdfGrid final : public Shape {
 public:
  enum class Normals {
    kAnalytic,  ///< the gradient within the cell
    kSmooth,    ///< blended from those of the eight cells around the nearest sample: continuous
  };

  /// Throws std::invalid_argument: sizes that do not fit, values that are not finite, no cell with a change of sign, a
  /// map that is not affine.
  SdfGrid(SdfSamples samples, Normals normals, const Transform& to_world = {}, bool flip_normals = false);

  Bounds3 bounds() const override { return bounds_; }
  float area() const override { return 0; }  ///< not known
  size_t primitive_count() const override { return cells_.size(); }
  /// The function is not negative anywhere on the faces of the cube.
  bool is_closed() const override { return closed_; }
  SurfacePoint surface_point(const Ray& ray, const Hit& hit) const override;
  /// Throws std::logic_error.
  AreaSample sample_area(const Vec2& u) const override;
  RTCGeometry make_embree_geometry(RTCDevice device) const override;
  float distance_bound(const Vec3& p, uint32_t primitive) const override;

  /// Distance along the ray to the first crossing of the level in a cell with t > 0, or infinity; any length of
  /// direction.
  double intersect(const Vec3& origin, const Vec3& direction, uint32_t primitive) const;
  /// World bounds of a cell.
  Bounds3 cell_bounds(uint32_t primitive) const;
  /// Normal on the outside, not normalised, at a point near the surface.
  Vec3 normal_at(const Imath::V3d& p) const;

 private:
  using Corners = std::array<double, 8>;  ///< x + 2 y + 4 z

  std::array<int, 3> cell_place(uint32_t primitive) const;
  Corners corners(const std::array<int, 3>& cell) const;
  double sample(int x, int y, int z) const;
  Imath::V3d to_grid(const Imath::V3d& p) const;
  /// Value and gradient (per grid step) at a point in grid coordinates, which are cells from the cube's corner.
  struct Local {
    double value;
    Imath::V3d gradient;
  };
  Local eval(const Imath::V3d& grid) const;
  Imath::V3d smooth_gradient(const Imath::V3d& grid) const;
  Vec3 outward(const Imath::V3d& gradient) const;

  SdfSamples samples_;
  Normals normals_;
  bool flip_normals_, closed_ = true;
  Transform grid_to_world_, world_to_grid_;
  std::vector<uint32_t> cells_;  ///< index of the lowest corner
  Bounds3 bounds_;
  double least_stretch_;  ///< world length per grid step, at least
};

}  // namespace turbid
