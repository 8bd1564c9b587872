#pragma once
#include <mutex>
#include <optional>

#include "image/splat_buffer.h"
#include "integrator/integrator.h"
#include "path/light_sources.h"
#include "path/path_settings.h"
#include "path/sample_counters.h"

namespace turbid {

/// Light tracing: paths start at lights, and each of their vertices is joined with the sensor. Good where light is
/// focused before it meets what scatters; the slowest way for what scatters little towards the sensor.
///
/// What it cannot sample, and leaves black: what the sensor sees in mirrors and through refractive boundaries without
/// roughness (no connection can obey the law of reflection by chance); glowing media; the sky behind an orthographic
/// sensor. Alpha is 1 everywhere.
///
/// For each sample index as many light paths are traced as the film has pixels; the picture that they make together is
/// one sample of every pixel, so means and variances are those of other integrators per sample. Path i of sample n is
/// named by (seed, n, i); splats are summed in fixed point: the same bits for any number of threads.
class ParticleTracer : public Integrator {
 public:
  explicit ParticleTracer(const PathSettings& settings) : settings_(settings) {}

  /// Finds the scale of the fixed-point sums by a pilot of some thousand paths.
  void prepare(const Scene& scene, uint64_t seed, const StopFlag& stop) override;
  bool render_pass(const Scene& scene, const Pass& pass, Film& film, const StopFlag& stop) override;
  Counters counters() const override;

 private:
  void add_counters(const SampleCounters& counters);

  PathSettings settings_;
  std::optional<LightSources> sources_;
  int largest_exponent_ = 0;  ///< of the splats of the pilot: they are below 2^largest_exponent
  mutable std::mutex mutex_;
  SampleCounters totals_;
  uint64_t saturated_ = 0;
};

}  // namespace turbid
