#pragma once
#include <string>
#include <vector>

namespace turbid::bench {

/// How fast, and how good for the time, one scene renders.
struct RenderResult {
  std::string scene;
  unsigned long long samples = 0;  ///< camera samples
  double seconds = 0;              ///< wall, of the passes
  double samples_per_second = 0;
  double rmse = 0;                     ///< root of the mean squared error of one render, over pixels and channels
  double efficiency = 0;               ///< RMSE^2 x seconds: lower is better, and the same for any number of samples
  unsigned long long peak_memory = 0;  ///< bytes
};

/// Renders the scene twice with different seeds by calling `program`. The squared error of either is estimated without
/// a reference as half of the mean squared difference of the two, which has that expectation for an unbiased
/// integrator. Throws std::runtime_error when the program fails.
RenderResult measure_render(const std::string& program, const std::string& scene, int samples_per_pixel);

}  // namespace turbid::bench
