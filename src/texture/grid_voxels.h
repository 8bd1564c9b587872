#pragma once
#include <Imath/half.h>

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/spectrum.h"

namespace turbid {

/// Numbers of voxels along x, y, z, or the place of one.
struct Voxel {
  int x = 0, y = 0, z = 0;
  friend bool operator==(const Voxel&, const Voxel&) = default;
};

/// How a voxel is stored: half floats have 11 significant bits and end at 65504.
enum class VoxelFormat { kFloat, kHalf };

/// The voxels of a grid with 1 or 3 channels, in bricks of 8 x 8 x 8. A brick whose voxels are all equal is stored as
/// one value, so that empty space costs 4 bytes per 512 voxels; the others take 2 or 4 bytes per voxel and channel.
/// Every brick knows its smallest and largest value.
class GridVoxels {
 public:
  static constexpr int kBrickSize = 8;
  static constexpr int kBrickVoxels = kBrickSize * kBrickSize * kBrickSize;
  /// Most bricks that a grid may span: their table takes 512 MiB.
  static constexpr size_t kMaxBricks = size_t{1} << 27;

  GridVoxels() = default;
  /// Size at least 1 along each axis; all voxels hold `fill`. Throws std::invalid_argument: wrong size, channels not 1
  /// or 3, more bricks than kMaxBricks.
  GridVoxels(const Voxel& size, int channels, VoxelFormat format, const Spectrum& fill = Spectrum(0.0f));

  /// Dense data in the order ((z * ny + y) * nx + x) * channels + channel. Throws std::invalid_argument also for values
  /// that are not finite (in half: above 65504).
  static GridVoxels from_dense(const Voxel& size, int channels, VoxelFormat format, std::span<const float> values);

  /// Replaces a brick (its place in bricks) by values in the order ((z * 8 + y) * 8 + x) * channels + channel. Throws
  /// std::invalid_argument for values that are not finite.
  void set_brick(const Voxel& brick, std::span<const float> values);
  /// Replaces it by one value.
  void set_brick(const Voxel& brick, const Spectrum& value);

  const Voxel& size() const { return size_; }
  /// Bricks along each axis.
  const Voxel& bricks() const { return bricks_; }
  int channels() const { return channels_; }
  VoxelFormat format() const { return format_; }
  /// Bytes that the data take.
  size_t memory() const;

  /// The value of a voxel of the grid; grids of 1 channel give it in all channels.
  Spectrum at(int x, int y, int z) const;

  /// The values at the corners (x0|x1, y0|y1, z0|z1), x fastest, z slowest.
  std::array<Spectrum, 8> corners(int x0, int x1, int y0, int y1, int z0, int z1) const;

  /// Collects bounds and sum of the voxels between two corners, both included and inside the grid.
  struct Summary {
    Spectrum min{std::numeric_limits<float>::infinity()}, max{-std::numeric_limits<float>::infinity()};
    std::array<double, kChannels> sum{};
    double count = 0;
  };
  void summarise(const Voxel& first, const Voxel& last, Summary& summary) const;

 private:
  /// What the table says about a brick whose voxels are stored.
  struct Stored {
    Spectrum min, max, mean;
  };
  static constexpr uint32_t kUniform = 0x80000000u;  ///< the rest of the entry is an index into uniform_

  size_t place(int bx, int by, int bz) const {
    return (static_cast<size_t>(bz) * static_cast<size_t>(bricks_.y) + static_cast<size_t>(by)) *
               static_cast<size_t>(bricks_.x) +
           static_cast<size_t>(bx);
  }
  Spectrum value(uint32_t entry, int within) const;
  uint32_t uniform_entry(const Spectrum& value);

  Voxel size_, bricks_;
  int channels_ = 1;
  VoxelFormat format_ = VoxelFormat::kFloat;
  std::vector<uint32_t> table_;
  std::vector<Spectrum> uniform_;  ///< distinct neighbours in the order of their making
  std::vector<Stored> stored_;
  std::vector<float> floats_;
  std::vector<Imath::half> halves_;
};

}  // namespace turbid
