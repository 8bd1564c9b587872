#include "core/distribution.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/rng.h"

namespace turbid {

DiscreteDistribution::DiscreteDistribution(std::span<const float> weights) : cdf_(weights.size() + 1, 0.0) {
  for (size_t i = 0; i < weights.size(); ++i) {
    if (!(weights[i] >= 0) || !std::isfinite(weights[i]))
      throw std::invalid_argument("a weight of a distribution is negative or not finite");
    cdf_[i + 1] = cdf_[i] + static_cast<double>(weights[i]);
  }
  sum_ = cdf_.back();
  if (sum_ > 0)
    for (double& c : cdf_) c /= sum_;
}

DiscreteSample DiscreteDistribution::sample(float u) const {
  // The last entry not above u: entries of weight 0 have an empty interval and are never found.
  const auto above = std::upper_bound(cdf_.begin() + 1, cdf_.end(), static_cast<double>(u));
  auto index = static_cast<size_t>(std::min(above, cdf_.end() - 1) - cdf_.begin()) - 1;
  while (index > 0 && cdf_[index + 1] == cdf_[index]) --index;
  const double low = cdf_[index], width = cdf_[index + 1] - low;
  const double rest = (static_cast<double>(u) - low) / width;
  return {index, static_cast<float>(width), std::clamp(static_cast<float>(rest), 0.0f, kOneMinusEpsilon)};
}

Distribution2D::Distribution2D(std::span<const float> weights, size_t nx, size_t ny) : nx_(nx), ny_(ny) {
  if (weights.size() != nx * ny || weights.empty())
    throw std::invalid_argument("a 2D distribution needs one weight for each of its cells");
  std::vector<float> sums;
  for (size_t y = 0; y < ny; ++y) {
    rows_.emplace_back(weights.subspan(y * nx, nx));
    sums.push_back(static_cast<float>(rows_.back().sum()));
  }
  marginal_ = DiscreteDistribution(sums);
}

Distribution2D::Sample Distribution2D::sample(const Vec2& u) const {
  const DiscreteSample row = marginal_.sample(u.y);
  const DiscreteSample cell = rows_[row.index].sample(u.x);
  const Vec2 p{(static_cast<float>(cell.index) + cell.u) / static_cast<float>(nx_),
               (static_cast<float>(row.index) + row.u) / static_cast<float>(ny_)};
  return {p, row.prob * cell.prob * static_cast<float>(nx_ * ny_)};
}

float Distribution2D::pdf_a(const Vec2& p) const {
  const auto cell = [](float v, size_t n) {
    return std::min(static_cast<size_t>(std::max(v, 0.0f) * static_cast<float>(n)), n - 1);
  };
  const size_t x = cell(p.x, nx_), y = cell(p.y, ny_);
  if (rows_[y].sum() == 0) return 0;
  return marginal_.prob(y) * rows_[y].prob(x) * static_cast<float>(nx_ * ny_);
}

}  // namespace turbid
