#include "image/outlier_rejection.h"

#include <algorithm>

#include "core/parallel.h"
#include "image/color.h"
#include "image/film_image.h"

namespace turbid {
namespace {

/// What counts as brightness where there is none, in units of the ladder's start: the paper's tool has 0.05 and 1.
constexpr double kDarkest = 0.05;

/// Stands for the light beyond the last cascade.
constexpr size_t kBeyond = Cascades::kCount;

struct Rgb {
  double values[kChannels] = {};

  void add(std::span<const double> other, double weight) {
    for (size_t c = 0; c < kChannels; ++c) values[c] += weight * other[c];
  }
  double luminance() const {
    double sum = 0;
    for (int c = 0; c < kChannels; ++c) sum += kRgbToXyz[1][c] * values[c];
    return sum;
  }
};

class Development {
 public:
  Development(const Film& film, const Cascades& cascades, const OutlierSettings& settings)
      : film_(film),
        cascades_(cascades),
        samples_(static_cast<double>(film.samples())),
        darkest_(kDarkest * settings.start),
        trusted_(std::min(settings.kappa, (samples_ - 1) / 4)) {}

  /// What is to be taken from the sum over the samples of a pixel.
  Rgb removed(int x, int y) const {
    const size_t pixel = index(x, y);
    const std::span<const double> layers = film_.layers(pixel);
    Rgb kept, removed, beyond;
    beyond.add(film_.pixel(pixel).radiance, 1);
    for (size_t j = 0; j < Cascades::kCount; ++j) {
      const std::span<const double> sums = cascade(layers, j);
      if (std::ranges::all_of(sums, [](double sum) { return sum == 0; })) continue;
      const double weight = j == 0 ? 1 : reliability(x, y, j, cascades_.brightness(j), kept);
      kept.add(sums, weight);
      removed.add(sums, 1 - weight);
      beyond.add(sums, -1);
    }
    // What the cascades lack is a cascade of its own; only samples of the last one can have left something there.
    if (const double count = cascades_.count(layers, kBeyond - 1); count > 0) {
      for (double& value : beyond.values) value = std::max(0.0, value);
      const double brightness = beyond.luminance() / std::max(count, 1.0);
      if (brightness > 0) removed.add(beyond.values, 1 - reliability(x, y, kBeyond, brightness, kept));
    }
    return removed;
  }

 private:
  size_t index(int x, int y) const {
    return static_cast<size_t>(y) * static_cast<size_t>(film_.size().x) + static_cast<size_t>(x);
  }
  std::span<const double> cascade(std::span<const double> layers, size_t j) const {
    return layers.subspan(cascades_.channel(j), kChannels);
  }

  /// r_j of a pixel, where `kept` is what it keeps of the cascades below.
  double reliability(int x, int y, size_t j, double brightness, const Rgb& kept) const {
    const double block = block_count(x, y, j), count = block >= 1 ? like(index(x, y), j) : block;
    const double support = std::max(kept.luminance(), samples_ * darkest_) / brightness;
    return std::clamp((count - 1 + support) / (2 * trusted_), 0.0, 1.0);
  }

  /// Samples of the pixel that are like those of cascade j.
  double like(size_t pixel, size_t j) const {
    double sum = 0;
    for (size_t k = j - 1; k <= std::min(j + 1, Cascades::kCount - 1); ++k)
      sum += cascades_.count(film_.layers(pixel), k);
    return sum;
  }

  /// The same, on average over the 3x3 block around a pixel, as far as it lies on the film.
  double block_count(int x, int y, size_t j) const {
    double sum = 0;
    int pixels = 0;
    for (int v = std::max(y - 1, 0); v <= std::min(y + 1, film_.size().y - 1); ++v)
      for (int u = std::max(x - 1, 0); u <= std::min(x + 1, film_.size().x - 1); ++u, ++pixels)
        sum += like(index(u, v), j);
    return sum / pixels;
  }

  const Film& film_;
  const Cascades& cascades_;
  double samples_, darkest_, trusted_;
};

double luminance(const Image& image, const char* const (&names)[kChannels]) {
  double sum = 0;
  for (int c = 0; c < kChannels; ++c)
    for (const float value : image.channel(names[c])) sum += kRgbToXyz[1][c] * static_cast<double>(value);
  return sum;
}

}  // namespace

Image reject_outliers(const Image& image, const Film& film, const OutlierSettings& settings) {
  Image result = with_channels(image, {std::begin(kUnweightedNames), std::end(kUnweightedNames)});
  for (size_t c = 0; c < kChannels; ++c)
    std::ranges::copy(image.channel(c), result.channel(kUnweightedNames[c]).begin());
  const std::optional<Cascades> cascades = Cascades::in(film, settings);
  if (!cascades || film.samples() < 2) return result;

  const Development development(film, *cascades, settings);
  const auto width = static_cast<size_t>(film.size().x);
  parallel_for(static_cast<size_t>(film.size().y), [&](size_t y) {
    for (size_t x = 0; x < width; ++x) {
      const Rgb removed = development.removed(static_cast<int>(x), static_cast<int>(y));
      const size_t pixel = y * width + x;
      for (size_t c = 0; c < kChannels; ++c)
        result.channel(c)[pixel] = static_cast<float>(std::max(0.0, film.pixel(pixel).radiance[c] - removed.values[c]) /
                                                      static_cast<double>(film.samples()));
    }
  });
  return result;
}

double rejected_share(const Image& image) {
  const double mean = luminance(image, kUnweightedNames);
  return mean > 0 ? 1 - luminance(image, {"R", "G", "B"}) / mean : 0;
}

}  // namespace turbid
