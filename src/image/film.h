#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "core/parallel.h"
#include "core/spectrum.h"
#include "core/vector.h"

namespace turbid {

/// What one sample of one pixel saw.
struct PixelSample {
  Spectrum radiance;
  float alpha = 1;
};

/// The sums over the samples of one pixel in one pass.
struct PixelSums {
  double radiance[kChannels] = {};
  double squares[kChannels] = {};  ///< of the per-sample radiance: for variance and the second moment
  double products[kChannels] =
      {};  ///< of channel c and the next one, round: RG, GB, BR; for moments in other colour spaces
  double alpha = 0;

  void add(const PixelSample& sample) {
    for (int c = 0; c < kChannels; ++c) {
      const double value = static_cast<double>(sample.radiance[c]);
      radiance[c] += value;
      squares[c] += value * value;
      products[c] += value * static_cast<double>(sample.radiance[(c + 1) % kChannels]);
    }
    alpha += static_cast<double>(sample.alpha);
  }
  void add(const PixelSums& other) {
    for (int c = 0; c < kChannels; ++c) {
      radiance[c] += other.radiance[c];
      squares[c] += other.squares[c];
      products[c] += other.products[c];
    }
    alpha += other.alpha;
  }
};

/// The accumulators of an image (its crop window), row by row from the top. A pass writes into a Film of its own, which
/// is added to the total when the pass is whole: a pass counts entirely or not at all, so an interrupted render stays
/// exact.
///
/// Every pixel receives only its own samples: their positions are drawn from the reconstruction filter's density
/// (filter importance sampling, Ernst et al. 2006), which has the expectation of a normalised splat, keeps pixels
/// statistically independent, and needs no order of summation between threads.
class Film {
 public:
  Film() = default;
  explicit Film(const Vec2i& size) : size_(size), pixels_(static_cast<size_t>(size.x) * static_cast<size_t>(size.y)) {}

  const Vec2i& size() const { return size_; }
  size_t pixel_count() const { return pixels_.size(); }
  /// Samples taken of every pixel.
  uint64_t samples() const { return samples_; }

  PixelSums& pixel(size_t index) { return pixels_[index]; }
  const PixelSums& pixel(size_t index) const { return pixels_[index]; }

  /// All pixels, and the same to restore them from a checkpoint.
  std::span<const PixelSums> pixels() const { return pixels_; }
  std::span<PixelSums> pixels() { return pixels_; }

  void clear() {
    parallel_for(
        pixels_.size(), [this](size_t i) { pixels_[i] = {}; }, kGrain);
    samples_ = 0;
  }
  void add_samples(uint64_t n) { samples_ += n; }
  /// Adds a pass of the same size.
  void add(const Film& pass) {
    parallel_for(
        pixels_.size(), [&](size_t i) { pixels_[i].add(pass.pixels_[i]); }, kGrain);
    samples_ += pass.samples_;
  }

 private:
  static constexpr size_t kGrain = 4096;  ///< pixels per task

  Vec2i size_{0, 0};
  uint64_t samples_ = 0;
  std::vector<PixelSums> pixels_;
};

}  // namespace turbid
