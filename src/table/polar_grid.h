#pragma once
#include <span>
#include <vector>

#include "table/lanes.h"

namespace turbid {

/// Cells around a source that shines along +z, in polar coordinates: the distance r from it (mean free paths) and the
/// angle Theta of the position to +z. Cells are even in u = ln(1 + r/kScale) and in t = 0.8 s + 0.2 sqrt(s) with
/// s = sin(Theta/2): finer near the source and near the axis.
///
/// What lives here is a density T(r, Theta) per volume; it is stored as values of r T at the middles of cells, linear
/// between them in (u, t), and r T constant inside of the innermost ones.
class PolarGrid {
 public:
  static constexpr double kScale = 0.15;

  /// At least 4 cells each way; `outer` is the radius where the grid ends, in mean free paths.
  PolarGrid(int radii, int angles, double outer);

  int radii() const { return radii_; }
  int angles() const { return angles_; }
  double outer() const { return outer_; }
  size_t cell_count() const { return static_cast<size_t>(radii_) * static_cast<size_t>(angles_); }
  size_t index(int i, int j) const {
    return static_cast<size_t>(i) * static_cast<size_t>(angles_) + static_cast<size_t>(j);
  }

  /// Where r lies, in cells from the source: the middle of cell i is at i + 0.5.
  float radial(float r) const;
  /// Where cos(Theta) lies, in cells from the axis.
  float angular(float cosine) const;
  /// The same of eight places.
  Lanes radial(const Lanes& r) const;
  Lanes angular(const Lanes& cosine) const;
  /// Radius of the middle of a cell.
  double middle(int i) const { return radius(i + 0.5); }
  double radius(double cells) const;
  double cosine(double cells) const;

  /// From what lies in each cell (int T dV) to values at the middles whose interpolant has exactly that in each cell.
  void to_nodes(std::span<float> contents) const;
  /// The plain mean of r T in a cell with content 1.
  double mean_of_content(int i, int j) const {
    return 1 / (radial_mass_[static_cast<size_t>(i)] * angular_mass_[static_cast<size_t>(j)]);
  }
  /// int T dV over all cells, of an interpolant given by its values (even ones).
  double content(std::span<const float> nodes) const;

 private:
  /// What the interpolant's values at i-1, i, i+1 put into the cell i.
  struct Tridiagonal {
    std::vector<double> below, diagonal, above;
    void prepare();
    std::vector<double> factor, pivot;  ///< of Thomas' algorithm
  };
  Tridiagonal radial_matrix() const;
  Tridiagonal angular_matrix() const;

  int radii_, angles_;
  double outer_;
  float radial_scale_;
  Tridiagonal by_radius_, by_angle_;
  std::vector<double> radial_mass_, angular_mass_;
};

}  // namespace turbid
