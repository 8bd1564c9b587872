#pragma once
#include <vector>

#include "core/vector.h"
#include "core/warp.h"

namespace turbid {

/// A reconstruction filter, used as a density: sample() draws an offset from the pixel's centre, in pixels, with a
/// density proportional to the filter, so every sample has weight 1. Two numbers.
class ReconstructionFilter {
 public:
  enum class Kind { kBox, kTent, kGaussian };

  ReconstructionFilter() = default;
  /// `radius` in pixels: half the width of the box or tent; for the Gaussian the standard deviation, truncated at 4 of
  /// them as in Mitsuba, and shifted so that it ends at zero there.
  ReconstructionFilter(Kind kind, float radius);

  Vec2 sample(const Vec2& u) const {
    switch (kind_) {
      case Kind::kBox:
        return {radius_ * (2 * u.x - 1), radius_ * (2 * u.y - 1)};
      case Kind::kTent:
        return {radius_ * interval_to_tent(u.x), radius_ * interval_to_tent(u.y)};
      case Kind::kGaussian:
        break;
    }
    return {sample_gaussian(u.x), sample_gaussian(u.y)};
  }

  /// The density of sample() factorises; this is one factor, per pixel, at an offset along one axis.
  float pdf_1d(float offset) const;
  /// Beyond this offset the density is 0.
  float support() const { return kind_ == Kind::kGaussian ? inverse_cdf_.front() : radius_; }

 private:
  float sample_gaussian(float u) const;
  Kind kind_ = Kind::kBox;
  float radius_ = 0.5f;
  std::vector<float> inverse_cdf_;  ///< quantiles of the truncated Gaussian in pixels, see the constructor
};

}  // namespace turbid
