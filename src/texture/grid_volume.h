#pragma once
#include "core/transform.h"
#include "texture/grid_voxels.h"
#include "texture/volume.h"

namespace turbid {

/// How a grid is read between and beyond its voxels.
enum class GridFilter { kTrilinear, kNearest };
enum class GridWrap { kClamp, kRepeat, kMirror };

struct GridSettings {
  GridFilter filter = GridFilter::kTrilinear;
  GridWrap wrap = GridWrap::kClamp;
  Transform to_world = {};  ///< from the grid's unit cube
};

/// Voxels spread over the unit cube of local coordinates, as in Mitsuba 3's `gridvolume`: voxel (i, j, k) of an
/// nx x ny x nz grid has its centre at ((i + 1/2)/nx, (j + 1/2)/ny, (k + 1/2)/nz); `to_world` takes the cube to the
/// world. The bounds are the axis-aligned world box around that cube; points outside of the cube read as `wrap` says.
class GridVolume final : public Volume {
 public:
  GridVolume(GridVoxels voxels, const GridSettings& settings);

  Spectrum eval(const Vec3& p) const override;
  ValueRange range(const Bounds3& box) const override;
  const Bounds3& bounds() const override { return bounds_; }
  Vec3 resolution() const override;

  const GridVoxels& voxels() const { return voxels_; }

 private:
  GridVoxels voxels_;
  GridSettings settings_;
  Transform to_grid_;  ///< world to voxel coordinates: voxel i covers [i, i+1]
  Bounds3 bounds_;
};

}  // namespace turbid
