#pragma once
#include <span>
#include <vector>

namespace turbid {

/// The channels of a picture side by side, as color_channels() gives them.
using ChannelList = std::vector<std::span<const float>>;

/// How far an image is from a reference, over all channels of all pixels where both are finite. With the difference
/// d = image - reference:
struct ImageMetrics {
  double rmse = 0;        ///< sqrt(mean d^2)
  double peak = 0;        ///< largest value of the reference
  double psnr = 0;        ///< 20 log10(peak / rmse), dB; infinite when the images are equal
  double rel_mse = 0;     ///< mean d^2 / (reference^2 + kRelMseFloor) (Rousselle et al. 2011)
  double mae = 0;         ///< mean |d|
  double mean_ratio = 0;  ///< mean image / mean reference: 1.01 is one percent too bright
  std::vector<double> channel_mean_ratios;
  size_t non_finite = 0;  ///< values left out because either is infinite or NaN
};

/// Keeps dark pixels from ruling rel_mse.
inline constexpr double kRelMseFloor = 0.01;

/// Both must have the same number of channels of the same length; std::invalid_argument otherwise.
ImageMetrics compare_images(const ChannelList& image, const ChannelList& reference);

}  // namespace turbid
