#include "texture/grid_voxels.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace turbid {
namespace {

constexpr int kBrick = GridVoxels::kBrickSize;

int index_within(int x, int y, int z) { return ((z & 7) * kBrick + (y & 7)) * kBrick + (x & 7); }

Spectrum lower(const Spectrum& a, const Spectrum& b) {
  return {std::min(a[0], b[0]), std::min(a[1], b[1]), std::min(a[2], b[2])};
}
Spectrum upper(const Spectrum& a, const Spectrum& b) {
  return {std::max(a[0], b[0]), std::max(a[1], b[1]), std::max(a[2], b[2])};
}

/// The number as it will be read back.
float rounded(float v, VoxelFormat format) {
  return format == VoxelFormat::kHalf ? static_cast<float>(Imath::half(v)) : v;
}

void check_finite(float v) {
  if (!std::isfinite(v)) throw std::invalid_argument("a grid holds a value that is not a finite number");
}

}  // namespace

GridVoxels::GridVoxels(const Voxel& size, int channels, VoxelFormat format, const Spectrum& fill)
    : size_(size), channels_(channels), format_(format) {
  if (size.x < 1 || size.y < 1 || size.z < 1) throw std::invalid_argument("a grid needs at least one voxel");
  if (channels != 1 && channels != 3) throw std::invalid_argument("a grid has 1 or 3 channels");
  const auto count = [](int n) { return static_cast<int>((static_cast<int64_t>(n) + kBrick - 1) / kBrick); };
  bricks_ = {count(size.x), count(size.y), count(size.z)};
  // Each factor is below 2^28.1, so the product of two fits.
  const size_t layer = static_cast<size_t>(bricks_.x) * static_cast<size_t>(bricks_.y);
  if (layer > kMaxBricks || layer * static_cast<size_t>(bricks_.z) > kMaxBricks)
    throw std::invalid_argument("the grid is too large");
  table_.assign(layer * static_cast<size_t>(bricks_.z), uniform_entry(fill));
}

GridVoxels GridVoxels::from_dense(const Voxel& size, int channels, VoxelFormat format, std::span<const float> values) {
  GridVoxels grid(size, channels, format);
  const auto width = static_cast<size_t>(channels);
  std::vector<float> brick(static_cast<size_t>(kBrickVoxels) * width);
  for (int bz = 0; bz < grid.bricks_.z; ++bz)
    for (int by = 0; by < grid.bricks_.y; ++by)
      for (int bx = 0; bx < grid.bricks_.x; ++bx) {
        // Bricks that stick out repeat the last voxel, which keeps their bounds and their evenness.
        size_t to = 0;
        for (int i = 0; i < kBrickVoxels; ++i) {
          const auto x = static_cast<size_t>(std::min(bx * kBrick + i % kBrick, size.x - 1));
          const auto y = static_cast<size_t>(std::min(by * kBrick + i / kBrick % kBrick, size.y - 1));
          const auto z = static_cast<size_t>(std::min(bz * kBrick + i / (kBrick * kBrick), size.z - 1));
          const size_t from = ((z * static_cast<size_t>(size.y) + y) * static_cast<size_t>(size.x) + x) * width;
          for (size_t c = 0; c < width; ++c) brick[to++] = values[from + c];
        }
        grid.set_brick({bx, by, bz}, brick);
      }
  return grid;
}

uint32_t GridVoxels::uniform_entry(const Spectrum& value) {
  Spectrum kept;
  for (int c = 0; c < kChannels; ++c) kept[c] = rounded(value[channels_ == 1 ? 0 : c], format_);
  for (int c = 0; c < kChannels; ++c) check_finite(kept[c]);
  // Most even bricks are empty or equal to the one before.
  if (!uniform_.empty() && uniform_.front() == kept) return kUniform;
  if (uniform_.empty() || !(uniform_.back() == kept)) uniform_.push_back(kept);
  return kUniform | static_cast<uint32_t>(uniform_.size() - 1);
}

void GridVoxels::set_brick(const Voxel& brick, const Spectrum& value) {
  table_[place(brick.x, brick.y, brick.z)] = uniform_entry(value);
}

void GridVoxels::set_brick(const Voxel& brick, std::span<const float> values) {
  const auto width = static_cast<size_t>(channels_);
  Stored facts{Spectrum(std::numeric_limits<float>::infinity()), Spectrum(-std::numeric_limits<float>::infinity()), {}};
  std::array<double, kChannels> sum{};
  for (size_t i = 0; i < static_cast<size_t>(kBrickVoxels); ++i) {
    Spectrum v;
    for (size_t c = 0; c < kChannels; ++c) {
      v[static_cast<int>(c)] = rounded(values[i * width + (width == 1 ? 0 : c)], format_);
      check_finite(v[static_cast<int>(c)]);
      sum[c] += double(v[static_cast<int>(c)]);
    }
    facts.min = lower(facts.min, v);
    facts.max = upper(facts.max, v);
  }
  if (facts.min == facts.max) return set_brick(brick, facts.min);
  for (size_t c = 0; c < kChannels; ++c) facts.mean[static_cast<int>(c)] = static_cast<float>(sum[c] / kBrickVoxels);
  table_[place(brick.x, brick.y, brick.z)] = static_cast<uint32_t>(stored_.size());
  stored_.push_back(facts);
  const auto end = values.begin() + static_cast<std::ptrdiff_t>(static_cast<size_t>(kBrickVoxels) * width);
  if (format_ == VoxelFormat::kFloat) {
    floats_.insert(floats_.end(), values.begin(), end);
  } else {
    std::transform(values.begin(), end, std::back_inserter(halves_), [](float v) { return Imath::half(v); });
  }
}

size_t GridVoxels::memory() const {
  return table_.size() * sizeof(uint32_t) + uniform_.size() * sizeof(Spectrum) + stored_.size() * sizeof(Stored) +
         floats_.size() * sizeof(float) + halves_.size() * sizeof(Imath::half);
}

Spectrum GridVoxels::value(uint32_t entry, int within) const {
  if (entry & kUniform) return uniform_[entry & ~kUniform];
  const size_t i = static_cast<size_t>(entry) * kBrickVoxels + static_cast<size_t>(within);
  if (format_ == VoxelFormat::kFloat) {
    if (channels_ == 1) return Spectrum(floats_[i]);
    return {floats_[3 * i], floats_[3 * i + 1], floats_[3 * i + 2]};
  }
  if (channels_ == 1) return Spectrum(static_cast<float>(halves_[i]));
  return {static_cast<float>(halves_[3 * i]), static_cast<float>(halves_[3 * i + 1]),
          static_cast<float>(halves_[3 * i + 2])};
}

Spectrum GridVoxels::at(int x, int y, int z) const {
  return value(table_[place(x >> 3, y >> 3, z >> 3)], index_within(x, y, z));
}

std::array<Spectrum, 8> GridVoxels::corners(int x0, int x1, int y0, int y1, int z0, int z1) const {
  const bool together = (x0 >> 3) == (x1 >> 3) && (y0 >> 3) == (y1 >> 3) && (z0 >> 3) == (z1 >> 3);
  std::array<Spectrum, 8> result;
  if (together) {
    const uint32_t entry = table_[place(x0 >> 3, y0 >> 3, z0 >> 3)];
    if (entry & kUniform) {
      result.fill(uniform_[entry & ~kUniform]);
      return result;
    }
    for (int i = 0; i < 8; ++i)
      result[static_cast<size_t>(i)] = value(entry, index_within(i & 1 ? x1 : x0, i & 2 ? y1 : y0, i & 4 ? z1 : z0));
    return result;
  }
  for (int i = 0; i < 8; ++i) result[static_cast<size_t>(i)] = at(i & 1 ? x1 : x0, i & 2 ? y1 : y0, i & 4 ? z1 : z0);
  return result;
}

void GridVoxels::summarise(const Voxel& first, const Voxel& last, Summary& summary) const {
  const auto add = [&](const Spectrum& min, const Spectrum& max, const Spectrum& mean, double count) {
    summary.min = lower(summary.min, min);
    summary.max = upper(summary.max, max);
    for (size_t c = 0; c < kChannels; ++c) summary.sum[c] += double(mean[static_cast<int>(c)]) * count;
    summary.count += count;
  };
  for (int bz = first.z >> 3; bz <= last.z >> 3; ++bz)
    for (int by = first.y >> 3; by <= last.y >> 3; ++by)
      for (int bx = first.x >> 3; bx <= last.x >> 3; ++bx) {
        const Voxel low{std::max(first.x, bx * kBrick), std::max(first.y, by * kBrick), std::max(first.z, bz * kBrick)};
        const Voxel high{std::min(last.x, bx * kBrick + 7), std::min(last.y, by * kBrick + 7),
                         std::min(last.z, bz * kBrick + 7)};
        const int count = (high.x - low.x + 1) * (high.y - low.y + 1) * (high.z - low.z + 1);
        const uint32_t entry = table_[place(bx, by, bz)];
        if (entry & kUniform) {
          const Spectrum& v = uniform_[entry & ~kUniform];
          add(v, v, v, count);
        } else if (count == kBrickVoxels) {
          const Stored& facts = stored_[entry];
          add(facts.min, facts.max, facts.mean, count);
        } else {
          for (int z = low.z; z <= high.z; ++z)
            for (int y = low.y; y <= high.y; ++y)
              for (int x = low.x; x <= high.x; ++x) {
                const Spectrum v = value(entry, index_within(x, y, z));
                add(v, v, v, 1);
              }
        }
      }
}

}  // namespace turbid
