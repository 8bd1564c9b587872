#pragma once
#include <array>
#include <span>
#include <vector>

#include "core/spectrum.h"
#include "core/vector.h"

namespace turbid {

/// Power that leaves a medium through its boundary or at a surface in it, W: where, and towards where (unit), it was
/// scattered last.
struct LeavingPower {
  Vec3 scattered, direction;
  Spectrum power;
};

/// How much more light leaves each part of a medium than was predicted: a ratio for each channel on a grid of the
/// places where light is scattered for the last time and of six directions, trilinear between nodes and by the squares
/// of a direction's components between directions. A node that little light tells of takes over the ratio of a larger
/// part around it, up to that of all; 1 where nothing is known. Immutable.
class LightBalance {
 public:
  LightBalance() = default;
  /// A grid of about so many cells around all that leaves.
  LightBalance(std::span<const LeavingPower> leaving, std::span<const LeavingPower> predicted, size_t cells);

  /// Of what is scattered at x towards w (unit).
  Spectrum at(const Vec3& x, const Vec3& w) const;

 private:
  static constexpr size_t kDirections = 6;  ///< +x, -x, +y ...
  using Ratios = std::array<Spectrum, kDirections>;
  using Cells = std::array<int, 3>;
  struct Level;
  struct Corner {
    size_t node;
    float weight;
  };
  /// Multiplies the ratios by what is still to be made good.
  void refine(std::span<const LeavingPower> leaving, std::span<const LeavingPower> predicted);
  static std::array<float, kDirections> direction_weights(const Vec3& w);
  /// The nodes around a place, with their trilinear weights; beyond the grid those of the next place on it.
  std::array<Corner, 8> corners(const Vec3& x) const;

  Vec3 origin_{0, 0, 0};
  float spacing_ = 0;
  Cells cells_{0, 0, 0};
  std::vector<Ratios> ratios_;  ///< of the nodes; empty: 1 everywhere
};

}  // namespace turbid
