#include "experiment/score.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>

namespace turbid {
namespace {

/// For each level that all runs have: the points there.
std::vector<Curve> by_level(const std::vector<Curve>& runs) {
  std::map<int, Curve> levels;
  for (const Curve& run : runs)
    for (const CurvePoint& point : run) levels[point.level].push_back(point);
  std::vector<Curve> common;
  for (auto& [level, points] : levels)
    if (points.size() == runs.size()) common.push_back(std::move(points));
  return common;
}

template <class Value>
Estimate mean_over(const Curve& points, const Value& value) {
  std::vector<double> values;
  for (const CurvePoint& point : points) values.push_back(value(point));
  return mean_of(values);
}

Estimate less(const Estimate& mean_square, const Estimate& own) {
  return {mean_square.value - own.value, std::hypot(mean_square.error, own.error)};
}

/// The root of an estimate that may have come out negative: then 0, with the size that it could have at one standard
/// error.
Estimate root_of(const Estimate& square) {
  if (square.value <= 0) return {0, std::sqrt(square.error)};
  const double root = std::sqrt(square.value);
  return {root, std::min(square.error / (2 * root), std::sqrt(square.error))};
}

/// When a run's error came down to `wanted` (RMSE), between the points of its curve on logarithmic axes.
std::optional<double> time_to(const Curve& run, double wanted, double own_mse) {
  const auto error = [&](const CurvePoint& p) {
    return std::sqrt(std::max(p.error.mse - own_mse, std::numeric_limits<double>::min()));
  };
  for (size_t i = 0; i < run.size(); ++i) {
    if (error(run[i]) > wanted) continue;
    if (i == 0) return run[i].seconds;
    const double high = std::log(error(run[i - 1])), low = std::log(error(run[i]));
    const double from = std::log(run[i - 1].seconds), to = std::log(run[i].seconds);
    return std::exp(from + (to - from) * (high - std::log(wanted)) / (high - low));
  }
  return {};
}

std::optional<Estimate> mean_time_to(const std::vector<Curve>& runs, double wanted, double own_mse) {
  std::vector<double> times;
  for (const Curve& run : runs)
    if (const auto time = time_to(run, wanted, own_mse)) times.push_back(*time);
  if (times.size() < runs.size()) return {};
  return mean_of(times);
}

}  // namespace

Estimate mean_of(const std::vector<double>& values) {
  const auto n = static_cast<double>(values.size());
  double sum = 0, squares = 0;
  for (const double value : values) sum += value;
  const double mean = sum / n;
  for (const double value : values) squares += (value - mean) * (value - mean);
  const bool alone = values.size() < 2;
  return {mean, alone ? std::numeric_limits<double>::infinity() : std::sqrt(squares / (n - 1) / n)};
}

Estimate ratio_of(const Estimate& a, const Estimate& b) {
  const double ratio = a.value / b.value;
  return {ratio, std::hypot(a.error / b.value, ratio * b.error / b.value)};
}

ImageError error_of(const ImageMetrics& metrics) {
  return {metrics.rmse * metrics.rmse, metrics.rel_mse, metrics.mean_ratio};
}

MethodScore score_of(const std::vector<Curve>& runs, const ReferenceError& reference, double wanted_error) {
  if (runs.empty()) throw std::invalid_argument("a score needs runs");
  Curve ends;
  for (const Curve& run : runs) {
    if (run.empty()) throw std::invalid_argument("a score needs a point in every run");
    ends.push_back(run.back());
  }
  MethodScore score;
  const Estimate seen = mean_over(ends, [](const CurvePoint& p) { return p.error.mse; });
  score.is_lost_in_reference = reference.mse.value > seen.value / 2;
  score.rmse = root_of(less(seen, reference.mse));
  score.relative = {score.rmse.value / reference.mean, score.rmse.error / reference.mean};
  constexpr double kDecibels = 8.685889638065037;  // 20 / ln 10
  score.psnr = {20 * std::log10(reference.peak / score.rmse.value), kDecibels * score.rmse.error / score.rmse.value};
  score.rel_mse = mean_over(ends, [&](const CurvePoint& p) { return p.error.rel_mse - reference.rel_mse; });
  score.mean_ratio = mean_over(ends, [](const CurvePoint& p) { return p.error.mean_ratio; });
  score.seconds = mean_over(ends, [](const CurvePoint& p) { return p.seconds; });
  score.samples = mean_over(ends, [](const CurvePoint& p) { return static_cast<double>(p.samples); });
  score.wall = mean_over(ends, [](const CurvePoint& p) { return p.wall; }).value;
  score.cost = mean_over(ends, [&](const CurvePoint& p) { return (p.error.mse - reference.mse.value) * p.seconds; });
  score.cost.error = std::hypot(score.cost.error, reference.mse.error * score.seconds.value);
  if (wanted_error > 0) score.seconds_to_error = mean_time_to(runs, wanted_error * reference.mean, reference.mse.value);

  std::vector<double> times, errors;
  for (const Curve& points : by_level(runs)) {
    const Estimate mse = mean_over(points, [](const CurvePoint& p) { return p.error.mse; });
    const Estimate seconds = mean_over(points, [](const CurvePoint& p) { return p.seconds; });
    const Estimate samples = mean_over(points, [](const CurvePoint& p) { return static_cast<double>(p.samples); });
    score.curve.push_back({seconds, root_of(less(mse, reference.mse)), samples.value});
    if (reference.mse.value > mse.value / 2) continue;
    times.push_back(seconds.value);
    errors.push_back(score.curve.back().rmse.value);
  }
  score.slope = log_slope(times, errors);
  return score;
}

const std::vector<std::string>& MethodScore::measures() {
  static const std::vector<std::string> kNames = {
      "rmse", "relative rmse", "psnr", "rel_mse", "cost", "seconds", "samples", "seconds to error", "mean ratio"};
  return kNames;
}

std::optional<Estimate> MethodScore::get(const std::string& measure) const {
  if (measure == "rmse") return rmse;
  if (measure == "relative rmse") return relative;
  if (measure == "psnr") return psnr;
  if (measure == "rel_mse") return rel_mse;
  if (measure == "cost") return cost;
  if (measure == "seconds") return seconds;
  if (measure == "samples") return samples;
  if (measure == "mean ratio") return mean_ratio;
  if (measure == "seconds to error") return seconds_to_error;
  throw std::invalid_argument("unknown measure '" + measure + "'");
}

std::optional<double> log_slope(const std::vector<double>& x, const std::vector<double>& y) {
  double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (size_t i = 0; i < x.size(); ++i) {
    if (!(x[i] > 0) || !(y[i] > 0)) continue;
    const double a = std::log(x[i]), b = std::log(y[i]);
    n += 1;
    sx += a;
    sy += b;
    sxx += a * a;
    sxy += a * b;
  }
  const double spread = n * sxx - sx * sx;
  if (n < 2 || !(spread > 1e-12 * n * sxx)) return {};
  return (n * sxy - sx * sy) / spread;
}

double percentile(std::vector<float> values, double p) {
  std::erase_if(values, [](float v) { return !std::isfinite(v); });
  if (values.empty()) return 0;
  const auto at = std::min(values.size() - 1, static_cast<size_t>(p * static_cast<double>(values.size())));
  std::ranges::nth_element(values, values.begin() + static_cast<std::ptrdiff_t>(at));
  return static_cast<double>(values[at]);
}

}  // namespace turbid
