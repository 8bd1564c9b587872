#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "image/metrics.h"

namespace turbid {

/// A number and its standard error.
struct Estimate {
  double value = 0, error = 0;
};

/// Mean and its standard error from independent repetitions; the error of a single one is infinite.
Estimate mean_of(const std::vector<double>& values);
/// a / b of two independent estimates, to first order.
Estimate ratio_of(const Estimate& a, const Estimate& b);

/// What a reference adds to the errors of everything that is held against it, and what errors are measured in.
struct ReferenceError {
  Estimate mse;            ///< its own mean squared error, over all channels of all pixels
  double rel_mse = 0;      ///< its own share of relMSE
  double mean = 0;         ///< of all channels of all pixels
  double peak = 0;         ///< for PSNR: 99th percentile of all channels of all pixels
  double by_variance = 0;  ///< mse once more, from the variance between samples: differs where samples share something
};

/// How far one image is from the reference, whose own error is still in these numbers.
struct ImageError {
  double mse = 0, rel_mse = 0, mean_ratio = 0;
};
ImageError error_of(const ImageMetrics& metrics);

/// A method's error at one moment of one run.
struct CurvePoint {
  double seconds = 0;  ///< processor time of all threads, since the beginning of prepare
  double wall = 0;     ///< seconds
  uint64_t samples = 0;
  int level = 0;  ///< which moment of the curve: points of one level are averaged over runs
  ImageError error{};
};
using Curve = std::vector<CurvePoint>;

/// The mean over runs at one moment of their curves.
struct ScorePoint {
  Estimate seconds, rmse;
  double samples = 0;
};

/// A method's numbers from runs with several seeds. The reference's own error is subtracted from squared errors.
struct MethodScore {
  Estimate rmse, relative, psnr, rel_mse, mean_ratio, seconds, samples;
  Estimate cost;  ///< squared error x processor time
  double wall = 0;
  /// Processor time until the error was as small as asked for, where every run came so far.
  std::optional<Estimate> seconds_to_error{};
  /// More than half of the squared error that was seen is the reference's.
  bool is_lost_in_reference = false;
  std::vector<ScorePoint> curve;
  std::optional<double> slope{};  ///< of ln RMSE over ln seconds; unbiased methods have -1/2

  /// The names that `get` knows.
  static const std::vector<std::string>& measures();
  /// A measure by name; empty where the score has none.
  std::optional<Estimate> get(const std::string& measure) const;
};

/// `wanted_error`: RMSE over the mean of the reference, for seconds_to_error; 0: not asked for. Every run needs at
/// least a point; the levels that all runs have make the curve.
MethodScore score_of(const std::vector<Curve>& runs, const ReferenceError& reference, double wanted_error = 0);

/// Slope of ln y over ln x by least squares; empty with fewer than two usable points.
std::optional<double> log_slope(const std::vector<double>& x, const std::vector<double>& y);

/// The value below which the share `p` of the finite values lies.
double percentile(std::vector<float> values, double p);

}  // namespace turbid
