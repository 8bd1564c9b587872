#pragma once
#include <array>
#include <vector>

#include "core/distribution.h"
#include "core/transform.h"
#include "emitter/emitter.h"

namespace turbid {

/// An image at infinity, in latitude and longitude. The conventions are those of Mitsuba's `envmap`:
/// - In the emitter's space +y is up. Image coordinates (x, y) in [0,1]^2, y down, show the direction
///   (sin(phi) sin(theta), cos(theta), -cos(phi) sin(theta)), phi = 2 pi x, theta = pi y: the middle of the image looks
///   along +z, its left edge along -z, a quarter from the left along +x.
/// - Columns are cells of the circle: column i stands at x = (i + 1/2) / width. Rows stand from pole to pole: row j at
///   y = j / (height - 1). Between them radiance is interpolated bilinearly, around the circle.
///
/// Sampling picks one cell of four neighbouring pixels by its mean luminance times its solid angle, and a point inside
/// it by the bilinear interpolation of the four luminances over (phi, cos theta). So the density is this interpolation
/// divided by its integral over the sphere: zero only where the radiance is, and proportional to its luminance but for
/// the curvature of cos(theta) within a cell.
class EnvironmentMap final : public EnvironmentEmitter {
 public:
  /// Pixels row by row from the top, linear RGB, multiplied by `scale`. At least 1 x 2, finite, not negative;
  /// to_world must keep angles. Else std::invalid_argument.
  EnvironmentMap(std::vector<Spectrum> pixels, int width, int height, const Transform& to_world, float scale);

  /// Empty only for a black map.
  std::optional<DirectLightSample> sample_direct(const Vec3& from, const Vec2& u) const override;
  Spectrum Le(const Vec3& direction) const override;
  float pdf_direct_w(const Vec3& direction) const override;
  /// From all directions, each through the disk of the scene's bounding sphere.
  Spectrum power() const override { return radiance_integral_ * disk_area(); }

 private:
  /// A cell of four pixels and the place in it.
  struct Place {
    int column, row;
    float x;       ///< fraction between columns
    float y;       ///< fraction between rows, in theta
    float height;  ///< fraction between rows, in cos(theta)
  };
  Place locate(const Vec3& world_direction) const;
  /// The corners (column, row), (column + 1, row), and the same of the next row.
  std::array<const Spectrum*, 4> corners(int column, int row) const;
  std::array<float, 4> corner_luminances(int column, int row) const;
  Spectrum radiance(const Place& place) const;
  float density(const Place& place) const;
  void build_distribution();

  std::vector<Spectrum> pixels_;
  int width_, height_;
  Transform to_world_, to_local_;
  std::vector<double> versine_;  ///< 1 - cos(theta) of each row of pixels, in double: near the poles rows are thin
  std::vector<DiscreteDistribution> columns_;  ///< of each row of cells
  DiscreteDistribution rows_;                  ///< of cells
  Spectrum radiance_integral_;                 ///< over the sphere, W/m^2
  double luminance_integral_ = 0;              ///< of the interpolation that is sampled
};

}  // namespace turbid
