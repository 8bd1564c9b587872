#pragma once
#include <algorithm>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/parallel.h"
#include "core/spectrum.h"
#include "core/vector.h"

namespace turbid {

/// Light that collided never, once, twice, or more often in media: the classes of scattering order that layers tell
/// apart.
inline constexpr int kOrderClasses = 4;

/// What one sample of one pixel saw.
struct PixelSample {
  Spectrum radiance;
  float alpha = 1;
  /// The radiance by order of scattering, by integrators that tell (Integrator::split_orders); else 0.
  Spectrum by_order[kOrderClasses] = {Spectrum(0.0f), Spectrum(0.0f), Spectrum(0.0f), Spectrum(0.0f)};
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
///
/// Beside radiance there may be layers: named channels of anything that a sample sees (see the `aov` integrator).
class Film {
 public:
  Film() = default;
  explicit Film(const Vec2i& size, std::vector<std::string> layer_names = {})
      : size_(size),
        pixels_(static_cast<size_t>(size.x) * static_cast<size_t>(size.y)),
        layer_names_(std::move(layer_names)),
        layers_(pixels_.size() * layer_names_.size()) {}

  const Vec2i& size() const { return size_; }
  size_t pixel_count() const { return pixels_.size(); }
  /// Samples taken of every pixel.
  uint64_t samples() const { return samples_; }

  PixelSums& pixel(size_t index) { return pixels_[index]; }
  const PixelSums& pixel(size_t index) const { return pixels_[index]; }

  /// All pixels, and the same to restore them from a checkpoint.
  std::span<const PixelSums> pixels() const { return pixels_; }
  std::span<PixelSums> pixels() { return pixels_; }

  /// Names of the channels of all layers: "albedo.R" ...
  const std::vector<std::string>& layer_names() const { return layer_names_; }
  /// The sums over the samples of one pixel, a number per channel.
  std::span<double> layers(size_t index) { return std::span(layers_).subspan(index * depth(), depth()); }
  std::span<const double> layers(size_t index) const { return std::span(layers_).subspan(index * depth(), depth()); }
  /// Those of all pixels, pixel by pixel.
  std::span<const double> layers() const { return layers_; }
  std::span<double> layers() { return layers_; }

  void clear() {
    parallel_for(
        pixels_.size(),
        [this](size_t i) {
          pixels_[i] = {};
          std::ranges::fill(layers(i), 0.0);
        },
        kGrain);
    samples_ = 0;
  }
  void add_samples(uint64_t n) { samples_ += n; }
  /// Adds a pass of the same size with the same layers.
  void add(const Film& pass) {
    parallel_for(
        pixels_.size(),
        [&](size_t i) {
          pixels_[i].add(pass.pixels_[i]);
          for (size_t c = 0; c < depth(); ++c) layers(i)[c] += pass.layers(i)[c];
        },
        kGrain);
    samples_ += pass.samples_;
  }

 private:
  static constexpr size_t kGrain = 4096;  ///< pixels per task

  size_t depth() const { return layer_names_.size(); }

  Vec2i size_{0, 0};
  uint64_t samples_ = 0;
  std::vector<PixelSums> pixels_;
  std::vector<std::string> layer_names_;
  std::vector<double> layers_;
};

}  // namespace turbid
