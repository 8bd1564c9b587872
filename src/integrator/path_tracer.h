#pragma once
#include "integrator/integrator_plugin.h"
#include "integrator/sampling_integrator.h"

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

  /// `connection`: how collisions next to a light are found; kVolumes only.
  PathTracer(Kind kind, const PathSettings& settings, const ConnectionSettings& connection = {})
      : kind_(kind), settings_(settings), connection_(connection) {}

  bool sees_media() const override { return kind_ == Kind::kVolumes; }

 protected:
  PixelSample sample_radiance(const Scene& scene, const SensorRay& camera, Sampler& sampler,
                              SampleCounters& counters) const override;

 private:
  Kind kind_;
  PathSettings settings_;
  ConnectionSettings connection_;
};

/// Rows of the integrator table: `path`, `direct`, `volpath`.
IntegratorPlugin path_row();
IntegratorPlugin direct_row();
IntegratorPlugin volpath_row();

}  // namespace turbid
