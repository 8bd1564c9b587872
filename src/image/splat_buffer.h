#pragma once
#include <atomic>
#include <cstdint>
#include <vector>

#include "core/spectrum.h"
#include "core/vector.h"
#include "image/filter.h"

namespace turbid {

/// An image that many threads add light to at any pixel. Sums are kept in fixed point, so that they do not depend on
/// the order of the additions: the same bits for any number of threads.
class SplatBuffer {
 public:
  /// Values are kept in multiples of 2^(largest_exponent - kFractionBits): about 2^largest_exponent is the largest
  /// value expected; those up to kHeadroomBits more are kept, larger ones are cut off there and counted.
  SplatBuffer(const Vec2i& size, int largest_exponent);

  /// Adds to a pixel, given by its number. Values must be finite and not negative.
  void add(size_t pixel, const Spectrum& value);
  /// What was added to a pixel since the last clear().
  Spectrum sum(size_t pixel) const;
  void clear();

  const Vec2i& size() const { return size_; }
  size_t pixel_count() const { return cells_.size() / kChannels; }
  /// Values that were cut off since construction: each made the picture darker than it should be.
  uint64_t saturated() const { return saturated_.load(std::memory_order_relaxed); }

  static constexpr int kFractionBits = 36;  ///< a value 2^-20 times the largest keeps 16 bits
  static constexpr int kHeadroomBits = 16;  ///< leaves room for 2^11 values of the largest size in one pixel

 private:
  Vec2i size_;
  double scale_, unit_;
  std::vector<std::atomic<int64_t>> cells_;  ///< pixel by pixel, channel by channel
  std::atomic<uint64_t> saturated_{0};
};

/// A pixel that a splat goes to, and its factor.
struct SplatTarget {
  Vec2i pixel;
  float weight = 0;  ///< 0: no pixel sees the place
};

/// Picks one of the pixels that see the film at `position` (in pixels) through the filter, in proportion to the
/// filter's density there. The weight is the sum of these densities over all pixels of the endless film, so that a
/// pixel's expectation is its own density: the light that it would find by drawing its samples from the filter. Two
/// numbers.
SplatTarget choose_pixel(const ReconstructionFilter& filter, const Vec2& position, const Vec2& u);

}  // namespace turbid
