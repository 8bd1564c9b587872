#include "medium/angular_table_phase.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "core/vector.h"

namespace turbid {

AngularTablePhase::AngularTablePhase(std::span<const Node> nodes) {
  if (nodes.size() < 2 || nodes.front().at != 0 || std::abs(nodes.back().at - std::numbers::pi) > 1e-6)
    throw std::invalid_argument("a table over angles must reach from 0 to pi");
  std::vector<float> x;
  std::vector<double> values;
  for (const Node& node : nodes) {
    if (!(node.value >= 0) || !std::isfinite(node.value))
      throw std::invalid_argument("a value of a tabulated phase function is negative or not finite");
    const auto place = static_cast<float>(sqr(std::sin(node.at / 2)));
    if (!x.empty() && !(place > x.back())) continue;
    x.push_back(place);
    values.push_back(node.value);
  }
  x.back() = 1;

  double sum = 0, first_moment = 0;  // integrals of f and x f over x
  for (size_t i = 0; i < x.size(); ++i) {
    table_.push_back({x[i], 0, sum});
    if (i + 1 == x.size()) break;
    const double begin = static_cast<double>(x[i]), width = static_cast<double>(x[i + 1]) - begin;
    const double v0 = values[i], v1 = values[i + 1];
    sum += width * (v0 + v1) / 2;
    first_moment += width * (begin * (v0 + v1) / 2 + width * (v0 + 2 * v1) / 6);
  }
  if (!(sum > 0)) throw std::invalid_argument("the values of a tabulated phase function are all zero");
  integral_ = 4 * std::numbers::pi * sum;  // a solid angle is 2 pi dmu = 4 pi dx
  mean_cosine_ = static_cast<float>(1 - 2 * first_moment / sum);
  std::vector<float> cdf;
  for (size_t i = 0; i < x.size(); ++i) {
    table_[i].density = static_cast<float>(values[i] / integral_);
    table_[i].cdf /= sum;
    cdf.push_back(static_cast<float>(table_[i].cdf));
  }
  x_index_ = NodeIndex(std::move(x));
  cdf_index_ = NodeIndex(std::move(cdf));
}

float AngularTablePhase::at(float x) const {
  const float inside = std::clamp(x, 0.0f, 1.0f);
  const size_t i = x_index_.interval(inside);
  const Entry &begin = table_[i], &end = table_[i + 1];
  const float t = (inside - begin.x) / (end.x - begin.x);
  return begin.density + t * (end.density - begin.density);
}

float AngularTablePhase::eval_angle(float theta) const { return at(sqr(std::sin(theta / 2))); }

float AngularTablePhase::sample(float u) const {
  const double target = 1 - static_cast<double>(u);  // x falls while mu grows with u
  const size_t i = cdf_index_.interval(static_cast<float>(target));
  const Entry &begin = table_[i], &end = table_[i + 1];
  const double width = static_cast<double>(end.x) - static_cast<double>(begin.x);
  // In the interval the CDF grows by 4 pi width (f0 t + (f1 - f0) t^2 / 2), t in [0, 1]; the root without cancellation.
  const auto f0 = static_cast<double>(begin.density), f1 = static_cast<double>(end.density);
  const double c = (target - begin.cdf) / (4 * std::numbers::pi * width);
  const double denominator = f0 + std::sqrt(std::max(0.0, f0 * f0 + 2 * (f1 - f0) * c));
  const double t = denominator > 0 ? std::clamp(2 * c / denominator, 0.0, 1.0) : 0.0;
  return static_cast<float>(1 - 2 * (static_cast<double>(begin.x) + width * t));
}

std::vector<float> AngularTablePhase::landmarks() const {
  std::vector<float> angles;
  for (const Entry& entry : table_) {
    const auto x = static_cast<double>(entry.x);
    angles.push_back(static_cast<float>(2 * std::atan2(std::sqrt(x), std::sqrt(1 - x))));
  }
  return angles;
}

}  // namespace turbid
