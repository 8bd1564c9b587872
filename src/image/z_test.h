#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "core/vector.h"
#include "image/film.h"
#include "image/metrics.h"

namespace turbid {

/// The verdict of many z-tests, one per value (pixel or block, times component).
struct ZTestResult {
  size_t tests = 0, passed = 0;
  double level = 0;       ///< of each test, after Sidak's correction
  double smallest_p = 1;  ///< two-sided
  double worst_z = 0;
  size_t worst_index = 0;  ///< pixel or block with the smallest p-value

  double pass_fraction() const { return tests ? static_cast<double>(passed) / static_cast<double>(tests) : 0; }
  /// At least kAcceptedFraction of the tests do not reject (NUMERICS 10).
  bool accepted() const { return tests > 0 && pass_fraction() >= kAcceptedFraction; }

  static constexpr double kSignificance = 0.01;
  static constexpr double kAcceptedFraction = 0.9975;
};

/// Three channels of CIE XYZ.
using XyzImage = std::array<std::vector<double>, 3>;

/// Linear RGB to XYZ by the linear map; it also undoes the encoding of variance_image() and of Mitsuba's *_var.exr,
/// which is the variance of X, Y, Z mapped to RGB as if it were a colour.
XyzImage to_xyz(const ChannelList& rgb);

/// Is `image`, a mean of `spp` samples per pixel, consistent with a reference and the variance of one sample (all in
/// XYZ)? z = |image - reference| sqrt(spp / max(variance, 1e-4)) per component, at level 0.01 with Sidak's correction
/// over the number of pixels: the test by which Mitsuba judges its renders (NUMERICS 10). Values that are not finite
/// fail.
ZTestResult z_test(const XyzImage& image, uint64_t spp, const XyzImage& reference, const XyzImage& variance);

/// Means and variances over passes of blocks of pixels: what two estimators are compared by. Each film added is one
/// observation per block and channel.
class PassStatistics {
 public:
  /// Blocks of `block` x `block` pixels; those at the right and bottom edge may be smaller.
  PassStatistics(const Vec2i& size, int block);

  void add(const Film& pass);

  uint64_t passes() const { return passes_; }
  size_t block_count() const { return blocks_.size(); }
  Vec2i size() const { return size_; }
  int block() const { return block_; }
  /// Mean over passes, and variance of one pass (unbiased), of a block's mean radiance.
  double mean(size_t block, int channel) const { return blocks_[block].mean[static_cast<size_t>(channel)]; }
  double variance(size_t block, int channel) const;

 private:
  struct Block {
    std::array<double, kChannels> mean{}, m2{};
  };
  Vec2i size_;
  int block_;
  Vec2i columns_rows_;
  uint64_t passes_ = 0;
  std::vector<Block> blocks_;
};

/// Do two estimators have the same expectation? z = |m1 - m2| / sqrt(s1^2/n1 + s2^2/n2) per block and channel, s^2 over
/// passes, at level 0.01 with Sidak's correction over blocks (NUMERICS 10). Needs 32 passes of each and the same
/// blocks, else std::invalid_argument. Differences within float rounding (1e-6 of the mean) pass where there is no
/// variance. Blocks for which `skip` is true (empty: none) are left out.
ZTestResult two_estimator_z_test(const PassStatistics& a, const PassStatistics& b, const std::vector<bool>& skip = {});

}  // namespace turbid
