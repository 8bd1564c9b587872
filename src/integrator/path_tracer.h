#pragma once
#include <optional>

#include "integrator/entering_lights.h"
#include "integrator/integrator_plugin.h"
#include "integrator/sampling_integrator.h"
#include "refraction/refractive_scattering.h"

namespace turbid {

/// Unidirectional path tracing from the sensor: next-event estimation and scattering combined by multiple importance
/// sampling (power heuristic), Russian roulette on the throughput.
class PathTracer : public SamplingIntegrator {
 public:
  /// What the tracer sees of media and of surfaces that light passes straight through.
  enum class Kind {
    kSurfaces,  ///< `path`: media are ignored; passing straight through costs depth and blocks shadow rays
    kVolumes,   ///< `volpath`: media scatter; straight passage is free for paths and for shadow rays
  };

  /// kVolumes only: how collisions next to a light are found; how single scattering of light that smooth interfaces
  /// bend is (left out: by paths alone); how multiple scattering is, which asks for the defaults of the other two.
  PathTracer(Kind kind, const PathSettings& settings, const ConnectionSettings& connection = {},
             const std::optional<RefractiveSettings>& refraction = {}, const TableSettings& table = {},
             const EnteringLightsSettings& entering = {})
      : kind_(kind),
        settings_(settings),
        connection_(connection),
        refraction_(refraction),
        table_settings_(table),
        entering_settings_(entering) {}

  void prepare(const Scene& scene, uint64_t seed, const StopFlag& stop) override;
  bool render_pass(const Scene& scene, const Pass& pass, Film& film, const StopFlag& stop) override;
  bool sees_media() const override { return kind_ == Kind::kVolumes; }
  /// With refraction: delta lights through smooth meshes, as far as single scattering goes.
  PathSupport support() const override {
    return {.specular_at_delta_light = refraction_.has_value(),
            .glowing_media = table_settings_.source == TableSettings::Source::kNone};
  }

 protected:
  PixelSample sample_radiance(const Scene& scene, const SensorRay& camera, Sampler& sampler,
                              SampleCounters& counters) const override;

 private:
  PixelSample trace_with_table(const Scene& scene, const SensorRay& camera, Sampler& sampler,
                               SampleCounters& counters) const;

  Kind kind_;
  PathSettings settings_;
  ConnectionSettings connection_;
  std::optional<RefractiveSettings> refraction_;
  TableSettings table_settings_;
  EnteringLightsSettings entering_settings_;
  // Made by prepare().
  std::unique_ptr<const RefractiveScattering> scattering_;
  std::unique_ptr<const TableLight> table_;  ///< null: paths find all light
  EnteringLightSets entering_;
};

/// Rows of the integrator table: `path`, `direct`, `volpath`, `singlescatter`.
IntegratorPlugin path_row();
IntegratorPlugin direct_row();
IntegratorPlugin volpath_row();
IntegratorPlugin single_scatter_row();

}  // namespace turbid
