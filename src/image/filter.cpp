#include "image/filter.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace turbid {
namespace {

constexpr double kGaussianCut = 4;  ///< standard deviations
constexpr size_t kGaussianCells = 1024;

/// Mass of exp(-t^2/2) - exp(-kGaussianCut^2/2) on [0, x].
double gaussian_mass(double x) {
  const double floor = std::exp(-0.5 * kGaussianCut * kGaussianCut);
  return std::sqrt(std::numbers::pi / 2) * std::erf(x / std::numbers::sqrt2) - floor * x;
}

/// Share of the mass of exp(-t^2/2) - exp(-kGaussianCut^2/2) on [-cut, cut] that lies in |t| > x.
double gaussian_tail(double x) { return 1 - gaussian_mass(x) / gaussian_mass(kGaussianCut); }

/// The x in [0, cut] with gaussian_tail(x) = tail, by bisection.
double gaussian_quantile(double tail) {
  double low = 0, high = kGaussianCut;
  for (int i = 0; i < 50; ++i) {
    const double middle = 0.5 * (low + high);
    (gaussian_tail(middle) > tail ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

ReconstructionFilter::ReconstructionFilter(Kind kind, float radius) : kind_(kind), radius_(radius) {
  if (kind_ != Kind::kGaussian) return;
  // Tabulated over s = sqrt(tail): towards the cut the density falls to zero linearly, the tail quadratically, so that
  // the quantile is smooth in s all the way and interpolates well.
  inverse_cdf_.resize(kGaussianCells + 1);
  for (size_t i = 0; i <= kGaussianCells; ++i) {
    const double s = static_cast<double>(i) / static_cast<double>(kGaussianCells);
    inverse_cdf_[i] = radius_ * static_cast<float>(gaussian_quantile(s * s));
  }
  inverse_cdf_.front() = radius_ * static_cast<float>(kGaussianCut);
  inverse_cdf_.back() = 0;
}

float ReconstructionFilter::pdf_1d(float offset) const {
  const float t = std::abs(offset) / radius_;
  switch (kind_) {
    case Kind::kBox:
      return offset >= -radius_ && offset < radius_ ? 0.5f / radius_ : 0;  // each place in one pixel at radius 1/2
    case Kind::kTent:
      return std::max(0.0f, 1 - t) / radius_;
    case Kind::kGaussian:
      break;
  }
  static const auto floor = static_cast<float>(std::exp(-0.5 * kGaussianCut * kGaussianCut));
  static const auto scale = static_cast<float>(0.5 / gaussian_mass(kGaussianCut));
  return std::max(0.0f, std::exp(-0.5f * t * t) - floor) * scale / radius_;
}

float ReconstructionFilter::sample_gaussian(float u) const {
  const float centred = 2 * u - 1;
  const float s = std::sqrt(1 - std::abs(centred)) * static_cast<float>(kGaussianCells);
  const size_t cell = std::min(static_cast<size_t>(s), kGaussianCells - 1);
  const float t = s - static_cast<float>(cell);
  return std::copysign((1 - t) * inverse_cdf_[cell] + t * inverse_cdf_[cell + 1], centred);
}

}  // namespace turbid
