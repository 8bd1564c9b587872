#pragma once
#include <vector>

#include "table/far_field.h"
#include "table/scattering_table.h"

namespace turbid {

/// Light around one kind of source in an infinite medium of one albedo, mean free path 1, ready to be looked up: the
/// source radiance sum_{n >= from_order} r_n(x, w) per unit of flux, n counting all collisions, the last one at x, from
/// where the light leaves along w (NUMERICS 8; S1 eq. 4). 1/sr per cubic mean free path.
class LobeField final : public LightField {
 public:
  /// Throws std::invalid_argument unless 0 <= albedo <= kLargestAlbedo and from_order is 3, 4 or 5.
  LobeField(const ScatteringTable& table, SourceKind kind, double albedo, int from_order = 3);

  /// The source radiance at x from the source, whose axis (the direction of its light) is `axis`, towards w. Never
  /// negative. Beyond the grid the lobes of its edge go on, and fall off like the diffuse far field. Grows like 1/|x|
  /// at the source; finite at x = 0.
  float eval(const Vec3& x, const Vec3& axis, const Vec3& w) const override;

  /// The same at eight places, for less than eight times the cost.
  Lanes eval(const Vec3Lanes& x, const Vec3& axis, const Vec3& w) const;

  /// int over the sphere of eval over w: the density of last collisions times the albedo, per cubic mean free path.
  float density(const Vec3& x, const Vec3& axis) const override;

  const PolarGrid& grid() const { return grid_; }
  /// What goes on beyond its edge.
  const FarField& far_field() const { return far_field_; }

 private:
  /// The four nodes around a place.
  struct Corners {
    const float* rows[4];
    Lanes weights[4];
    Lanes at(size_t offset) const {
      const auto row = [&](int k) { return load_lanes(rows[k] + offset); };
      return (weights[0] * row(0) + weights[1] * row(1)) + (weights[2] * row(2) + weights[3] * row(3));
    }
  };
  /// Coordinates of the grid.
  Corners corners(float radial, float angular) const;
  Corners corners_of(float distance, float cosine) const;
  /// By which the interpolant, r T, is multiplied.
  float factor(float distance, float cosine) const;

  PolarGrid grid_;
  int degree_;
  FarField far_field_;
  std::vector<float> nodes_;  ///< [cell][l][m] r T_lm
  size_t cell_size_;
  float edge_;  ///< where the far field begins; at a node
};

/// Light that sets out along a stretch of some optical length, as the difference of two half-infinite ones. Looks at a
/// field of kRay, which must live as long.
class StretchField final : public LightField {
 public:
  StretchField(const LobeField& ray, float depth) : ray_(ray), depth_(depth), left_(std::exp(-depth)) {}
  float eval(const Vec3& x, const Vec3& axis, const Vec3& w) const override {
    return std::max(0.0f, ray_.eval(x, axis, w) - left_ * ray_.eval(x - axis * depth_, axis, w));
  }
  float density(const Vec3& x, const Vec3& axis) const override {
    return std::max(0.0f, ray_.density(x, axis) - left_ * ray_.density(x - axis * depth_, axis));
  }

 private:
  const LobeField& ray_;
  float depth_, left_;
};

}  // namespace turbid
