#pragma once
#include <cmath>
#include <string>

#include "integrator/integrators.h"
#include "scene/loader.h"

namespace turbid::testing {

/// Mean and standard error of an image's pixels, channel by channel and for all channels together.
struct ImageMean {
  double mean[kChannels] = {};
  double error[kChannels] = {};  ///< standard error of the mean
  double variance = 0;           ///< of one sample, mean over pixels and channels

  double grey() const { return (mean[0] + mean[1] + mean[2]) / kChannels; }
  double grey_error() const {
    return (error[0] + error[1] + error[2]) / kChannels;
  }  // channels may be fully correlated
};

inline ImageMean mean_of(const Film& film) {
  ImageMean result;
  const auto n = static_cast<double>(film.samples()), pixels = static_cast<double>(film.pixel_count());
  for (int c = 0; c < kChannels; ++c) {
    double variance_of_mean = 0;
    for (size_t i = 0; i < film.pixel_count(); ++i) {
      const double mean = film.pixel(i).radiance[c] / n;
      const double variance = std::max(0.0, film.pixel(i).squares[c] / n - mean * mean) * n / (n - 1);
      result.mean[c] += mean / pixels;
      variance_of_mean += variance / n;
      result.variance += variance / (pixels * kChannels);
    }
    result.error[c] = std::sqrt(variance_of_mean) / pixels;
  }
  return result;
}

/// Renders with the given integrator; no files, no budget.
inline Film render_with(const Scene& scene, Integrator& integrator, uint32_t samples, uint64_t seed = 1) {
  StopFlag stop;
  integrator.prepare(scene, seed, stop);
  Film film(scene.film().image_size(), integrator.layer_names());
  integrator.render_pass(scene, {seed, 0, samples}, film, stop);
  return film;
}

/// Renders a scene given as text, with the integrator that it names.
inline Film render_text(const std::string& xml, uint32_t samples, const Overrides& overrides = {}, uint64_t seed = 1) {
  LoadedScene loaded = load_scene_from_string(xml, "test scene", overrides);
  const IntegratorSetup setup = make_integrator(loaded.integrator, loaded.document.get());
  const Scene scene(std::move(loaded.parts));
  return render_with(scene, *setup.integrator, samples, seed);
}

/// |a - b| in standard errors.
inline double z_score(double a, double error_a, double b, double error_b = 0) {
  return std::abs(a - b) / std::sqrt(error_a * error_a + error_b * error_b);
}

}  // namespace turbid::testing
