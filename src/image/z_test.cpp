#include "image/z_test.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "image/color.h"

namespace turbid {
namespace {

constexpr double kVarianceFloor = 1e-4;
constexpr double kRounding = 1e-6;
constexpr uint64_t kFewestPasses = 32;

/// The level of each of n independent tests with which all together reject a true hypothesis with the given
/// significance.
double sidak_level(double significance, size_t n) {
  return -std::expm1(std::log1p(-significance) / static_cast<double>(std::max<size_t>(n, 1)));
}

void count_test(ZTestResult& result, double z, size_t index) {
  // erfc keeps small p-values that 1 - erf would round away; NaN does not pass.
  const double p = std::isnan(z) ? 0 : std::erfc(z / std::numbers::sqrt2);
  ++result.tests;
  if (p > result.level) ++result.passed;
  if (p < result.smallest_p || (p == result.smallest_p && z > result.worst_z)) {
    result.smallest_p = p;
    result.worst_z = z;
    result.worst_index = index;
  }
}

}  // namespace

XyzImage to_xyz(const ChannelList& rgb) {
  if (rgb.size() != 3) throw std::invalid_argument("XYZ needs three channels");
  XyzImage xyz;
  for (size_t c = 0; c < 3; ++c) {
    xyz[c].resize(rgb[0].size());
    for (size_t i = 0; i < rgb[0].size(); ++i)
      for (size_t k = 0; k < 3; ++k) xyz[c][i] += kRgbToXyz[c][k] * static_cast<double>(rgb[k][i]);
  }
  return xyz;
}

ZTestResult z_test(const XyzImage& image, uint64_t spp, const XyzImage& reference, const XyzImage& variance) {
  const size_t pixels = image[0].size();
  if (reference[0].size() != pixels || variance[0].size() != pixels)
    throw std::invalid_argument("images of a z-test have different sizes");
  ZTestResult result;
  result.level = sidak_level(ZTestResult::kSignificance, pixels);
  for (size_t c = 0; c < 3; ++c) {
    for (size_t i = 0; i < pixels; ++i) {
      const double v = variance[c][i];
      const double floored = v > kVarianceFloor ? v : std::isnan(v) ? v : kVarianceFloor;
      count_test(result, std::abs(image[c][i] - reference[c][i]) * std::sqrt(static_cast<double>(spp) / floored), i);
    }
  }
  return result;
}

PassStatistics::PassStatistics(const Vec2i& size, int block)
    : size_(size), block_(block), columns_rows_((size.x + block - 1) / block, (size.y + block - 1) / block) {
  if (block < 1) throw std::invalid_argument("blocks need at least one pixel");
  blocks_.resize(static_cast<size_t>(columns_rows_.x) * static_cast<size_t>(columns_rows_.y));
}

void PassStatistics::add(const Film& pass) {
  if (pass.size() != size_ || pass.samples() == 0) throw std::invalid_argument("not a pass of this size");
  ++passes_;
  for (size_t b = 0; b < blocks_.size(); ++b) {
    const int x0 = static_cast<int>(b) % columns_rows_.x * block_, y0 = static_cast<int>(b) / columns_rows_.x * block_;
    const int x1 = std::min(x0 + block_, size_.x), y1 = std::min(y0 + block_, size_.y);
    std::array<double, kChannels> sum{};
    for (int y = y0; y < y1; ++y)
      for (int x = x0; x < x1; ++x)
        for (size_t c = 0; c < kChannels; ++c)
          sum[c] +=
              pass.pixel(static_cast<size_t>(y) * static_cast<size_t>(size_.x) + static_cast<size_t>(x)).radiance[c];
    const double samples = static_cast<double>(pass.samples()) * (x1 - x0) * (y1 - y0);
    for (size_t c = 0; c < kChannels; ++c) {
      const double value = sum[c] / samples, delta = value - blocks_[b].mean[c];
      blocks_[b].mean[c] += delta / static_cast<double>(passes_);
      blocks_[b].m2[c] += delta * (value - blocks_[b].mean[c]);
    }
  }
}

double PassStatistics::variance(size_t block, int channel) const {
  return passes_ > 1 ? blocks_[block].m2[static_cast<size_t>(channel)] / static_cast<double>(passes_ - 1) : 0;
}

ZTestResult two_estimator_z_test(const PassStatistics& a, const PassStatistics& b, const std::vector<bool>& skip) {
  if (a.size() != b.size() || a.block() != b.block()) throw std::invalid_argument("estimators with different blocks");
  if (std::min(a.passes(), b.passes()) < kFewestPasses) throw std::invalid_argument("fewer than 32 passes");
  ZTestResult result;
  const auto skipped = static_cast<size_t>(std::count(skip.begin(), skip.end(), true));
  result.level = sidak_level(ZTestResult::kSignificance, a.block_count() - skipped);
  for (size_t i = 0; i < a.block_count(); ++i) {
    if (!skip.empty() && skip[i]) continue;
    for (int c = 0; c < kChannels; ++c) {
      const double rounding = kRounding * std::max(std::abs(a.mean(i, c)), std::abs(b.mean(i, c)));
      const double variance = a.variance(i, c) / static_cast<double>(a.passes()) +
                              b.variance(i, c) / static_cast<double>(b.passes()) + rounding * rounding;
      const double difference = std::abs(a.mean(i, c) - b.mean(i, c));
      count_test(result, difference == 0 ? 0 : difference / std::sqrt(variance), i);
    }
  }
  return result;
}

}  // namespace turbid
