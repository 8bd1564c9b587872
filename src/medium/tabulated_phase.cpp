#include "medium/tabulated_phase.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace turbid {

TabulatedPhase::TabulatedPhase(std::span<const float> values) {
  if (values.size() < 2) throw std::invalid_argument("a tabulated phase function needs at least two values");
  for (const float v : values)
    if (!(v >= 0) || !std::isfinite(v))
      throw std::invalid_argument("a value of a tabulated phase function is negative or not finite");

  const double width = 2 / static_cast<double>(values.size() - 1);
  double first_moment = 0;
  cdf_.push_back(0);
  for (size_t i = 0; i + 1 < values.size(); ++i) {
    const auto v0 = static_cast<double>(values[i]), v1 = static_cast<double>(values[i + 1]);
    const double mu0 = -1 + width * static_cast<double>(i);
    cdf_.push_back(cdf_.back() + width * (v0 + v1) / 2);
    first_moment += width * (mu0 * (v0 + v1) / 2 + width * (v0 + 2 * v1) / 6);  // int (mu0 + x) v(x) dx, v linear
  }
  const double integral = cdf_.back();
  if (!(integral > 0)) throw std::invalid_argument("the values of a tabulated phase function are all zero");
  for (double& c : cdf_) c /= integral;
  for (const float v : values)
    density_.push_back(static_cast<float>(static_cast<double>(v) / (integral * 2 * std::numbers::pi)));
  mean_cosine_ = static_cast<float>(first_moment / integral);
}

float TabulatedPhase::eval(float mu) const {
  const size_t intervals = density_.size() - 1;
  const float x = std::clamp((mu + 1) * 0.5f, 0.0f, 1.0f) * static_cast<float>(intervals);
  const size_t i = std::min(static_cast<size_t>(x), intervals - 1);
  const float t = x - static_cast<float>(i);
  return density_[i] * (1 - t) + density_[i + 1] * t;
}

float TabulatedPhase::sample(float u) const {
  const auto above = std::upper_bound(cdf_.begin() + 1, cdf_.end() - 1, static_cast<double>(u));
  const auto i = static_cast<size_t>(above - cdf_.begin()) - 1;
  // In the interval the CDF grows by width (f0 t + (f1 - f0) t^2 / 2), t in [0, 1]; the root without cancellation.
  const double width = 2 / static_cast<double>(density_.size() - 1);
  const double f0 = static_cast<double>(density_[i]), f1 = static_cast<double>(density_[i + 1]);
  const double c = (static_cast<double>(u) - cdf_[i]) / (width * 2 * std::numbers::pi);
  const double denominator = f0 + std::sqrt(std::max(0.0, f0 * f0 + 2 * (f1 - f0) * c));
  const double t = denominator > 0 ? std::clamp(2 * c / denominator, 0.0, 1.0) : 0.0;
  return static_cast<float>(std::min(-1 + width * (static_cast<double>(i) + t), 1.0));
}

std::vector<float> TabulatedPhase::landmarks() const {
  std::vector<float> angles;
  const double width = 2 / static_cast<double>(density_.size() - 1);
  for (size_t i = 1; i + 1 < density_.size(); ++i)
    angles.push_back(static_cast<float>(std::acos(-1 + width * static_cast<double>(i))));
  return angles;
}

}  // namespace turbid
