#include "medium/angle_distribution.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/vector.h"
#include "medium/phase_function.h"
#include "medium/refinement.h"

namespace turbid {
namespace {

constexpr float kBelowPi = 0x1.921fb4p+1f;  // the largest float below pi

/// Where to begin: quarters of octaves towards both ends, where peaks stand, and the landmarks. Below the first angle
/// every phase function here is flat.
std::vector<double> start_angles(const PhaseFunction& phase) {
  constexpr double kFirst = 1e-6, kStep = 1.189207115;
  const auto end = static_cast<double>(kPi);
  std::vector<double> angles{0, end};
  for (double theta = kFirst; theta < end / 2; theta *= kStep) {
    angles.push_back(theta);
    angles.push_back(static_cast<double>(static_cast<float>(end - theta)));
  }
  for (const float theta : phase.landmarks()) angles.push_back(std::clamp(static_cast<double>(theta), 0.0, end));
  std::sort(angles.begin(), angles.end());
  angles.erase(std::unique(angles.begin(), angles.end()), angles.end());
  return angles;
}

}  // namespace

AngleDistribution::AngleDistribution(const PhaseFunction& phase) {
  const auto weight = [&](double theta) {
    return theta * static_cast<double>(phase.eval_angle(static_cast<float>(theta)));
  };
  const std::vector<Node> nodes = refine(
      weight, [](double theta) { return theta; }, start_angles(phase));

  std::vector<float> angles, cdf;
  std::vector<double> values;
  for (const Node& node : nodes) {
    if (!(node.value >= 0) || !std::isfinite(node.value))
      throw std::invalid_argument("a phase function is negative or not finite");
    const auto angle = static_cast<float>(node.at);
    if (!angles.empty() && angle <= angles.back()) continue;  // nodes that floats do not tell apart
    angles.push_back(angle);
    values.push_back(node.value);
  }

  double integral = 0;
  for (size_t i = 0; i < angles.size(); ++i) {
    table_.push_back({angles[i], 0, integral});
    if (i + 1 == angles.size()) break;
    const double begin = static_cast<double>(angles[i]), width = static_cast<double>(angles[i + 1]) - begin;
    integral += width * (values[i] + values[i + 1]) / 2;
    // Z is what the weights scale with, so it is taken more precisely than from the table: Simpson's rule.
    moment_ += width * (values[i] + 4 * weight(begin + width / 2) + values[i + 1]) / 6;
  }
  if (!(integral > 0)) throw std::invalid_argument("a phase function is zero everywhere");
  for (size_t i = 0; i < angles.size(); ++i) {
    table_[i].density = static_cast<float>(values[i] / integral);
    table_[i].cdf /= integral;
    cdf.push_back(static_cast<float>(table_[i].cdf));
  }
  theta_index_ = NodeIndex(std::move(angles));
  cdf_index_ = NodeIndex(std::move(cdf));
}

float AngleDistribution::sample(float u) const {
  // The middle of the step of 2^-24 that u stands for: never an end, where the density may be 0.
  const double centred = static_cast<double>(u) + 0x1p-25;
  const size_t i = cdf_index_.interval(static_cast<float>(centred));
  const Entry &begin = table_[i], &end = table_[i + 1];
  const double width = static_cast<double>(end.theta) - static_cast<double>(begin.theta);
  // In the interval the CDF grows by width (p0 t + (p1 - p0) t^2 / 2), t in [0, 1]; the root without cancellation.
  const auto p0 = static_cast<double>(begin.density), p1 = static_cast<double>(end.density);
  const double c = (centred - begin.cdf) / width;
  const double denominator = p0 + std::sqrt(std::max(0.0, p0 * p0 + 2 * (p1 - p0) * c));
  const double t = denominator > 0 ? std::clamp(2 * c / denominator, 0.0, 1.0) : 0.0;
  return std::min(static_cast<float>(static_cast<double>(begin.theta) + width * t), kBelowPi);
}

float AngleDistribution::pdf(float theta) const {
  const size_t i = theta_index_.interval(theta);
  const Entry &begin = table_[i], &end = table_[i + 1];
  const float t = (theta - begin.theta) / (end.theta - begin.theta);
  return begin.density + std::clamp(t, 0.0f, 1.0f) * (end.density - begin.density);
}

}  // namespace turbid
