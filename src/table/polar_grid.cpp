#include "table/polar_grid.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "core/gauss_legendre.h"
#include "core/vector.h"

namespace turbid {
namespace {

/// t = kLinear s + (1 - kLinear) sqrt(s), where s = sin(Theta/2).
constexpr double kLinear = 0.8;
double half_sine(double t) {
  const double root = 1 - kLinear;
  return sqr((std::sqrt(root * root + 4 * kLinear * t) - root) / (2 * kLinear));
}

}  // namespace

PolarGrid::PolarGrid(int radii, int angles, double outer)
    : radii_(radii),
      angles_(angles),
      outer_(outer),
      radial_scale_(static_cast<float>(radii / std::log1p(outer / kScale))) {
  if (radii < 4 || angles < 4 || !(outer > 1))
    throw std::invalid_argument("a polar grid needs 4 x 4 cells and a radius");
  by_radius_ = radial_matrix();
  by_angle_ = angular_matrix();
  const auto sums = [](const Tridiagonal& matrix) {
    std::vector<double> result(matrix.diagonal.size());
    for (size_t i = 0; i < result.size(); ++i) result[i] = matrix.below[i] + matrix.diagonal[i] + matrix.above[i];
    return result;
  };
  radial_mass_ = sums(by_radius_);
  angular_mass_ = sums(by_angle_);
}

float PolarGrid::radial(float r) const { return radial_scale_ * std::log(1 + r * static_cast<float>(1 / kScale)); }

float PolarGrid::angular(float cosine) const {
  const float s = safe_sqrt((1 - cosine) / 2);
  return static_cast<float>(angles_) *
         (static_cast<float>(kLinear) * s + static_cast<float>(1 - kLinear) * std::sqrt(s));
}

Lanes PolarGrid::radial(const Lanes& r) const {
  return radial_scale_ * log_lanes(1 + r * static_cast<float>(1 / kScale));
}

Lanes PolarGrid::angular(const Lanes& cosine) const {
  const Lanes s = safe_sqrt((1 - cosine) / 2);
  return static_cast<float>(angles_) *
         (static_cast<float>(kLinear) * s + static_cast<float>(1 - kLinear) * std::experimental::sqrt(s));
}

double PolarGrid::radius(double cells) const {
  return kScale * std::expm1(cells / radii_ * std::log1p(outer_ / kScale));
}

double PolarGrid::cosine(double cells) const { return 1 - 2 * sqr(half_sine(cells / angles_)); }

PolarGrid::Tridiagonal PolarGrid::radial_matrix() const {
  // int T r^2 dr of r T = node value: weight r dr = r dr/dx dx
  const GaussLegendre rule(12);
  Tridiagonal m{std::vector<double>(static_cast<size_t>(radii_)),
                std::vector<double>(static_cast<size_t>(radii_)),
                std::vector<double>(static_cast<size_t>(radii_)),
                {},
                {}};
  const double step = std::log1p(outer_ / kScale) / radii_;
  for (int i = 0; i < radii_; ++i)
    for (size_t k = 0; k < rule.size(); ++k) {
      const double x = rule.node(k), r = radius(i + x);
      const double mass = r * step * (r + kScale) * rule.weight(k);
      const auto row = static_cast<size_t>(i);
      const double to_below = i > 0 ? std::max(0.0, 0.5 - x) : 0,
                   to_above = i + 1 < radii_ ? std::max(0.0, x - 0.5) : 0;
      m.below[row] += mass * to_below;
      m.above[row] += mass * to_above;
      m.diagonal[row] += mass * (1 - to_below - to_above);
    }
  m.prepare();
  return m;
}

PolarGrid::Tridiagonal PolarGrid::angular_matrix() const {
  // 2 pi int d(cos Theta), split at the middle of the cell, where the interpolant bends. Beyond the first and the last
  // middle stands the mirror image on the other side of the axis.
  const GaussLegendre rule(8);
  Tridiagonal m{std::vector<double>(static_cast<size_t>(angles_)),
                std::vector<double>(static_cast<size_t>(angles_)),
                std::vector<double>(static_cast<size_t>(angles_)),
                {},
                {}};
  for (int j = 0; j < angles_; ++j)
    for (int half = 0; half < 2; ++half)
      for (size_t k = 0; k < rule.size(); ++k) {
        const double x = (half + rule.node(k)) / 2, t = (j + x) / angles_, s = half_sine(t);
        // cos = 1 - 2 s^2
        const double mass = 2 * std::numbers::pi * 4 * s / (kLinear + (1 - kLinear) / (2 * std::sqrt(s))) / angles_ *
                            rule.weight(k) / 2;
        const auto row = static_cast<size_t>(j);
        const double off = std::abs(x - 0.5);
        m.diagonal[row] += mass * (1 - off);
        if (x < 0.5)
          (j > 0 ? m.below[row] : m.diagonal[row]) += mass * off;
        else
          (j + 1 < angles_ ? m.above[row] : m.diagonal[row]) += mass * off;
      }
  m.prepare();
  return m;
}

void PolarGrid::Tridiagonal::prepare() {
  factor.resize(diagonal.size());
  pivot.resize(diagonal.size());
  for (size_t i = 0; i < diagonal.size(); ++i) {
    factor[i] = i > 0 ? below[i] / pivot[i - 1] : 0;
    pivot[i] = diagonal[i] - (i > 0 ? factor[i] * above[i - 1] : 0);
  }
}

void PolarGrid::to_nodes(std::span<float> contents) const {
  // Thomas' algorithm along both axes.
  const auto rows = static_cast<size_t>(radii_), columns = static_cast<size_t>(angles_);
  const auto solve = [&](const Tridiagonal& m, size_t first, size_t stride, size_t count) {
    std::vector<double> values(count);
    for (size_t i = 0; i < count; ++i)
      values[i] = static_cast<double>(contents[first + i * stride]) - (i > 0 ? m.factor[i] * values[i - 1] : 0);
    for (size_t i = count; i-- > 0;) {
      values[i] = (values[i] - (i + 1 < count ? m.above[i] * values[i + 1] : 0)) / m.pivot[i];
      contents[first + i * stride] = static_cast<float>(values[i]);
    }
  };
  for (size_t j = 0; j < columns; ++j) solve(by_radius_, j, columns, rows);
  for (size_t i = 0; i < rows; ++i) solve(by_angle_, i * columns, 1, columns);
}

double PolarGrid::content(std::span<const float> nodes) const {
  double sum = 0;
  const auto rows = static_cast<size_t>(radii_), columns = static_cast<size_t>(angles_);
  const auto apply = [](const Tridiagonal& m, size_t i, const auto& value) {
    double result = m.diagonal[i] * value(i);
    if (i > 0) result += m.below[i] * value(i - 1);
    if (i + 1 < m.diagonal.size()) result += m.above[i] * value(i + 1);
    return result;
  };
  for (size_t i = 0; i < rows; ++i)
    for (size_t j = 0; j < columns; ++j)
      sum += apply(by_radius_, i, [&](size_t k) {
        return apply(by_angle_, j, [&](size_t l) { return static_cast<double>(nodes[k * columns + l]); });
      });
  return sum;
}

}  // namespace turbid
