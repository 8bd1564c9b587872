#pragma once
#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "image/film.h"

namespace turbid {

/// How a film tells outliers from the rest (see reject_outliers).
struct OutlierSettings {
  double start = 1;  ///< luminance of the lowest cascade: no sample below it is an outlier
  double base = 8;   ///< ratio of neighbouring cascades
  double kappa = 1;  ///< samples of a kind, beside the one in question, that make it trusted
};

/// A part of a sample, and the first of the three channels in the film's layers that it goes to.
struct CascadeShare {
  size_t channel;
  Spectrum value;
};

/// Sorts samples by brightness while they are made (Zirr et al. 2018): kCount sums of radiance beside the picture's
/// own, which are layers of the film, so that passes, checkpoints and resuming carry them like any other layer. Files
/// do not show them.
///
/// Cascade j stands for the luminance B_j = start * base^j. A sample of luminance v with B_j <= v < B_{j+1} is divided
/// between the two: the part
///
///   a = (B_j/v - 1/base) / (1 - 1/base)
///
/// of it goes to j, the rest to j + 1. Of all divisions this is the one that counts: the luminance in a cascade,
/// divided by that cascade's B, sums to
///
///   a v/B_j + (1 - a) v/B_{j+1}  =  v/B_j (a (1 - 1/base) + 1/base)  =  1
///
/// over both, so that numbers of samples need no sums of their own. Below B_0 a sample goes to cascade 0 whole, and
/// counts v/B_0. Above the last B only the part B/v is kept, which counts as one; the rest is what the cascades lack to
/// the picture's sum.
class Cascades {
 public:
  static constexpr size_t kCount = 8;  ///< with the default ladder the last B is 2 million

  /// `channel`: of the film's layers, where those of the cascades begin.
  explicit Cascades(const OutlierSettings& settings, size_t channel = 0);

  /// The cascades among the layers of a film. Empty without settings, and for a film without such layers.
  static std::optional<Cascades> in(const Film& film, const std::optional<OutlierSettings>& settings);

  /// The layers that a film needs, to come after all others.
  static std::vector<std::string> layer_names();
  static bool is_cascade(std::string_view layer_name);

  /// Divides a sample; values must be finite and not negative.
  std::array<CascadeShare, 2> split(const Spectrum& sample) const;
  /// Adds a sample to a pixel's layers.
  void add(std::span<double> layers, const Spectrum& sample) const;

  /// B_j.
  double brightness(size_t cascade) const { return brightness_[cascade]; }
  /// Where in the film's layers a cascade's three channels begin.
  size_t channel(size_t cascade) const { return channel_ + cascade * kChannels; }
  /// How many samples of the pixel fell into a cascade, in shares.
  double count(std::span<const double> layers, size_t cascade) const;

 private:
  size_t channel_;
  double inverse_base_;
  std::array<double, kCount> brightness_;
};

}  // namespace turbid
