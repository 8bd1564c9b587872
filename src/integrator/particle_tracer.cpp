#include "integrator/particle_tracer.h"

#include "path/walk.h"

namespace turbid {
namespace {

class Tracer final : public SplattingIntegrator::Worker {
 public:
  Tracer(const Scene& scene, const LightSources& sources, const PathSettings& settings,
         const ConnectionSettings& connection, uint64_t seed, SampleCounters& counters)
      : sources_(sources),
        sampler_(scene.sampler(), hash_counters(seed, kLightStream)),
        splatter_(scene, settings, connection, sampler_, counters),
        walk_(scene, settings, sampler_, counters, splatter_) {}

  float run(size_t pixel, uint64_t index, ContributionSink& sink) override {
    sampler_.start(pixel, index);
    splatter_.begin(sink);
    walk_.run(sources_);
    return 1;
  }

 private:
  const LightSources& sources_;
  Sampler sampler_;
  LightSplatter splatter_;
  LightWalk<LightSplatter> walk_;
};

}  // namespace

std::unique_ptr<SplattingIntegrator::Worker> ParticleTracer::make_worker(const Scene& scene, uint64_t seed,
                                                                         SampleCounters& counters) const {
  return std::make_unique<Tracer>(scene, *sources_, settings_, connection_, seed, counters);
}

IntegratorPlugin particle_tracer_row() {
  return {"ptracer",
          {},
          "light tracing: paths from the lights, joined with the sensor; cannot see through mirrors and smooth glass",
          with_common_parameters(connection_parameters("camera_connection", "sensor")),
          [](const Properties& properties) {
            return IntegratorSetup{std::make_shared<ParticleTracer>(
                                       path_settings(properties), connection_settings(properties, "camera_connection")),
                                   false};
          }};
}

}  // namespace turbid
