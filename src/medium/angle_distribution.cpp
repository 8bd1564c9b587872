#include "medium/angle_distribution.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/vector.h"
#include "medium/phase_function.h"
#include "medium/refinement.h"

namespace turbid {
namespace {

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

/// The quadratic through three values at equal distances, or a line where that would become negative.
struct Quadratic {
  double slope, bend;  ///< along the distance before the end
  Quadratic(double begin, double middle, double end, double width)
      : slope((-3 * end + 4 * middle - begin) / width), bend(2 * (end - 2 * middle + begin) / (width * width)) {
    const double turn = bend > 0 ? -slope / (2 * bend) : -1;
    const bool dips = turn > 0 && turn < width && end + turn * (slope + turn * bend) < 0;
    if (middle >= 0 && !dips) return;
    slope = (begin - end) / width;
    bend = 0;
  }
};

/// Where an increasing function of w in [0, width] has the value `wanted`: Newton's method, kept in its bracket.
template <class Function, class Derivative>
double invert(double width, double wanted, const Function& function, const Derivative& derivative) {
  const double rise = wanted - function(0), first = derivative(0), last = derivative(width);
  if (!(rise > 0)) return 0;
  double low = 0, high = width;
  // Nearly right where the derivative is nearly linear: the root of its integral, without cancellation.
  const double denominator = first + std::sqrt(std::max(0.0, first * first + 2 * (last - first) * rise / width));
  double w = denominator > 0 ? std::min(2 * rise / denominator, width) : width;
  for (int i = 0; i < 60; ++i) {
    const double off = function(w) - wanted;
    (off < 0 ? low : high) = w;
    double next = w - off / derivative(w);
    if (!(next >= low && next <= high)) next = (low + high) / 2;
    // The step after this one would be the square of this one.
    if (std::abs(next - w) <= 1e-7 * width) return next;
    w = next;
  }
  return w;
}

}  // namespace

AngleDistribution::AngleDistribution(const PhaseFunction& phase) {
  const auto f = [&](double theta) { return static_cast<double>(phase.eval_angle(static_cast<float>(theta))); };
  const std::vector<Node> nodes = refine(
      f, [](double theta) { return theta; }, start_angles(phase));

  std::vector<float> angles;
  std::vector<double> values;
  for (const Node& node : nodes) {
    if (!(node.value >= 0) || !std::isfinite(node.value))
      throw std::invalid_argument("a phase function is negative or not finite");
    const auto angle = static_cast<float>(node.at);
    if (!angles.empty() && angle <= angles.back()) continue;  // nodes that floats do not tell apart
    angles.push_back(angle);
    values.push_back(node.value);
  }
  for (size_t i = 0; i + 1 < angles.size(); ++i) {
    const double begin = static_cast<double>(angles[i]),
                 end = std::min(static_cast<double>(angles[i + 1]), std::numbers::pi);
    const double width = end - begin;
    const Quadratic q(values[i], f(begin + width / 2), values[i + 1], width);
    table_.push_back({end, width, values[i + 1], q.slope, q.bend});
  }
  // From pi down, so that small tails keep their digits.
  for (size_t i = table_.size() - 1; i-- > 0;) {
    const Interval& after = table_[i + 1];
    table_[i].tail = after.tail_at(after.width);
    table_[i].integral = after.integral_at(after.width);
  }
  by_theta_ = NodeIndex(std::move(angles));
  if (!(moment() > 0)) throw std::invalid_argument("a phase function is zero everywhere");
  std::vector<float> tails, integrals;
  for (size_t i = table_.size(); i-- > 0;) {
    tails.push_back(static_cast<float>(table_[i].tail));
    integrals.push_back(static_cast<float>(table_[i].integral));
  }
  tails.push_back(static_cast<float>(tail(0)));
  integrals.push_back(static_cast<float>(integral(0)));
  by_tail_ = NodeIndex(std::move(tails));
  by_integral_ = NodeIndex(std::move(integrals));
}

double AngleDistribution::sample(const Range& range, double u) const {
  const double wanted = range.last + range.moment() * (1 - u);
  const Interval& found = table_[table_.size() - 1 - by_integral_.interval(static_cast<float>(wanted))];
  const double w = invert(
      found.width, wanted, [&](double x) { return found.integral_at(x); }, [&](double x) { return found.tail_at(x); });
  return std::clamp(found.end - w, range.from, range.to);
}

double AngleDistribution::sample_beyond(double gamma, double u, double to) const {
  const double last = tail(to), mass = tail(gamma) - last, wanted = last + mass * (1 - u);
  if (!(mass > 0)) return gamma;
  const Interval& found = table_[table_.size() - 1 - by_tail_.interval(static_cast<float>(wanted))];
  const double w = invert(
      found.width, wanted, [&](double x) { return found.tail_at(x); }, [&](double x) { return found.f_at(x); });
  return std::clamp(found.end - w, gamma, to);
}

double AngleDistribution::pdf_beyond(double gamma, double theta, double to) const {
  const double mass = tail(gamma) - tail(to);
  return theta >= gamma && theta <= to && mass > 0 ? f(theta) / mass : 0;
}

double AngleDistribution::f(double theta) const {
  const Interval& i = interval(theta);
  return std::max(i.f_at(std::clamp(i.end - theta, 0.0, i.width)), 0.0);
}

double AngleDistribution::tail(double theta) const {
  const Interval& i = interval(theta);
  return i.tail_at(std::clamp(i.end - theta, 0.0, i.width));
}

double AngleDistribution::integral(double theta) const {
  const Interval& i = interval(theta);
  return i.integral_at(std::clamp(i.end - theta, 0.0, i.width));
}

}  // namespace turbid
