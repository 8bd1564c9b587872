#pragma once
#include <optional>

#include "integrator/integrator_plugin.h"
#include "integrator/light_splatter.h"
#include "path/light_sources.h"

namespace turbid {

/// Light tracing: paths start at lights, and each of their vertices is joined with the sensor. Good where light is
/// focused before it meets what scatters; the slowest way for what scatters little towards the sensor.
///
/// What it cannot sample, and leaves black: what the sensor sees in mirrors and through refractive boundaries without
/// roughness (no connection can obey the law of reflection by chance); glowing media; the sky behind an orthographic
/// sensor. Alpha is 1 everywhere.
class ParticleTracer : public SplattingIntegrator {
 public:
  explicit ParticleTracer(const PathSettings& settings, const ConnectionSettings& connection = {})
      : settings_(settings), connection_(connection) {}

  PathSupport support() const override {
    return {.specular_at_sensor = false, .specular_at_delta_light = true, .beams = true, .glowing_media = false};
  }

 protected:
  std::unique_ptr<Worker> make_worker(const Scene& scene, uint64_t seed, SampleCounters& counters) const override;
  void prepare_workers(const Scene& scene) override { sources_.emplace(scene, true); }

 private:
  PathSettings settings_;
  ConnectionSettings connection_;
  std::optional<LightSources> sources_;
};

/// Row of the integrator table: `ptracer`.
IntegratorPlugin particle_tracer_row();

}  // namespace turbid
