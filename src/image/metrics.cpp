#include "image/metrics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace turbid {

ImageMetrics compare_images(const ChannelList& image, const ChannelList& reference) {
  if (image.size() != reference.size()) throw std::invalid_argument("images have different numbers of channels");
  ImageMetrics m;
  double squares = 0, relative = 0, absolute = 0, sum = 0, reference_sum = 0;
  size_t count = 0;
  m.peak = -std::numeric_limits<double>::infinity();
  for (size_t c = 0; c < image.size(); ++c) {
    if (image[c].size() != reference[c].size()) throw std::invalid_argument("images have different sizes");
    double channel_sum = 0, channel_reference_sum = 0;
    for (size_t i = 0; i < image[c].size(); ++i) {
      const auto a = static_cast<double>(image[c][i]), b = static_cast<double>(reference[c][i]);
      if (!std::isfinite(a) || !std::isfinite(b)) {
        ++m.non_finite;
        continue;
      }
      const double d = a - b;
      squares += d * d;
      relative += d * d / (b * b + kRelMseFloor);
      absolute += std::abs(d);
      channel_sum += a;
      channel_reference_sum += b;
      m.peak = std::max(m.peak, b);
      ++count;
    }
    m.channel_mean_ratios.push_back(channel_sum / channel_reference_sum);
    sum += channel_sum;
    reference_sum += channel_reference_sum;
  }
  const auto n = static_cast<double>(count);
  m.rmse = std::sqrt(squares / n);
  m.rel_mse = relative / n;
  m.mae = absolute / n;
  m.mean_ratio = sum / reference_sum;
  m.psnr = 20 * std::log10(m.peak / m.rmse);
  return m;
}

}  // namespace turbid
