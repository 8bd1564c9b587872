#pragma once
#include <array>
#include <optional>
#include <vector>

#include "core/ray.h"
#include "core/spectrum.h"

namespace turbid {

/// What is known about the extinction within one cell of a MajorantGrid, all in 1/unit.
struct MajorantCell {
  float majorant = 0;  ///< at least the extinction of every channel
  Spectrum minorant;   ///< at most the extinction, per channel
  Spectrum mean;       ///< about its average, per channel
};

/// A coarse grid over a box that bounds a density locally, so that tracking takes large steps where little is.
class MajorantGrid {
 public:
  /// A grid of nx x ny x nz cells over a box that is not empty.
  MajorantGrid(const Bounds3& box, const std::array<int, 3>& cells);

  const Bounds3& box() const { return box_; }
  const std::array<int, 3>& cell_counts() const { return counts_; }
  /// The box of a cell, widened by a little on all sides, so that points on a ray whose rounding puts them just
  /// outside of the cell are bounded as well.
  Bounds3 cell_box(int x, int y, int z) const;
  MajorantCell& cell(int x, int y, int z) { return cells_[index(x, y, z)]; }
  const MajorantCell& cell(int x, int y, int z) const { return cells_[index(x, y, z)]; }

  /// The cell that p lies in; outside of the box the one next to it.
  const MajorantCell& cell_at(const Vec3& p) const { return cell(place(p, 0), place(p, 1), place(p, 2)); }

  /// The part of a ray within the box, as distances; empty when it misses.
  std::optional<std::array<float, 2>> clip(const Ray& ray) const;

  /// Calls visit(cell, t0, t1) for the cells along the ray within [0, ray.t_max), in order, with the distances at which
  /// the ray enters and leaves them, until visit returns false (Amanatides & Woo 1987). The parts join without gaps.
  template <class Visit>
  void walk(const Ray& ray, const Visit& visit) const;

 private:
  /// The number of the cell along an axis; the comparisons also catch NaN.
  int place(const Vec3& p, unsigned axis) const {
    const float cells = (p[axis] - box_.min[axis]) / cell_size_[axis];
    return !(cells > 0) ? 0 : cells < static_cast<float>(counts_[axis]) ? static_cast<int>(cells) : counts_[axis] - 1;
  }
  size_t index(int x, int y, int z) const {
    return (static_cast<size_t>(z) * static_cast<size_t>(counts_[1]) + static_cast<size_t>(y)) *
               static_cast<size_t>(counts_[0]) +
           static_cast<size_t>(x);
  }

  Bounds3 box_;
  std::array<int, 3> counts_;
  Vec3 cell_size_;
  std::vector<MajorantCell> cells_;
};

template <class Visit>
void MajorantGrid::walk(const Ray& ray, const Visit& visit) const {
  const auto part = clip(ray);
  if (!part) return;
  float t = (*part)[0];
  const float end = (*part)[1];
  const Vec3 entry = ray.at(t);
  std::array<int, 3> at, step;
  std::array<float, 3> next, delta;  // distance to the next wall across each axis; between walls
  for (unsigned a = 0; a < 3; ++a) {
    const float d = ray.direction[a];
    at[a] = place(entry, a);
    step[a] = d > 0 ? 1 : -1;
    delta[a] = d == 0 ? kInfinity : cell_size_[a] / std::abs(d);
    const float wall = box_.min[a] + cell_size_[a] * static_cast<float>(at[a] + (d > 0));
    next[a] = d == 0 ? kInfinity : (wall - ray.origin[a]) / d;
  }
  while (true) {
    const unsigned a = next[0] < next[1] ? (next[0] < next[2] ? 0 : 2) : (next[1] < next[2] ? 1 : 2);
    const float leave = std::max(t, std::min(next[a], end));
    if (leave > t && !visit(cell(at[0], at[1], at[2]), t, leave)) return;
    if (!(next[a] < end)) return;
    t = leave;
    at[a] += step[a];
    if (at[a] < 0 || at[a] >= counts_[a]) {
      // The last wall, short of the end by rounding: the rest belongs to the cell before it.
      at[a] -= step[a];
      if (end > t) visit(cell(at[0], at[1], at[2]), t, end);
      return;
    }
    next[a] += delta[a];
  }
}

}  // namespace turbid
