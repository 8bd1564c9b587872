#include "integrator/particle_tracer.h"

#include "path/sensor_connector.h"
#include "path/walk.h"

namespace turbid {
namespace {

/// Joins the vertices of light paths with the sensor.
class LightSplatter : public WalkRecorder {
 public:
  LightSplatter(const Scene& scene, const PathSettings& settings, Sampler& sampler, SampleCounters& counters)
      : settings_(settings), connector_(scene, static_cast<double>(pixel_count(scene.film())), sampler, counters) {}

  void begin(ContributionSink& sink) { sink_ = &sink; }

  void at_emitter(const Emission& emission, const Traveller& traveller) {
    if (settings_.hide_emitters || settings_.min_scattering > 0) return;
    splat(connector_.arrive_from(emission, traveller), emission.throughput, 1, 0);
  }

  void at_surface(const SurfaceEvent& event, const PathState& state, const Traveller& traveller) {
    if (!settings_.order_counts(state.order) || !(event.object.bsdf->flags() & lobe::kSmooth)) return;
    const SurfacePoint& point = event.point;
    const auto way = connector_.way_from(point.p);
    if (!way) return;
    const Vec3 wo = normalize(way->position - point.p);
    const float correction = adjoint_correction(point, event.given, wo);
    if (correction == 0) return;
    const Spectrum scattered =
        event.object.bsdf->eval(point, event.given_local, point.to_local(wo), TransportMode::kImportance).value;
    const Spectrum flux = state.throughput * scattered * correction;
    splat(connector_.arrive(*way, point.leave(wo), flux, traveller, &event), flux, state.depth + 1, state.order);
  }

  void at_collision(const CollisionEvent& event, const PathState& state, const Traveller& traveller) {
    if (!settings_.order_counts(state.order)) return;
    const auto way = connector_.way_from(event.position);
    if (!way) return;
    const Vec3 wo = normalize(way->position - event.position);
    const Spectrum flux = state.throughput * event.medium.phase().eval(dot(event.direction, wo));
    splat(connector_.arrive(*way, event.position, flux, traveller), flux, state.depth + 1, state.order);
  }

 private:
  void splat(const std::optional<SensorArrival>& arrival, const Spectrum& flux, int light_vertices, int order) {
    if (!arrival) return;
    sink_->splat(
        connector_.index_of(arrival->target.pixel),
        {.value = flux * arrival->weight, .light_vertices = light_vertices, .sensor_vertices = 1, .order = order});
  }

  const PathSettings& settings_;
  SensorConnector connector_;
  ContributionSink* sink_ = nullptr;
};

}  // namespace

std::unique_ptr<SplattingIntegrator::Worker> ParticleTracer::make_worker(const Scene& scene, uint64_t seed,
                                                                         SampleCounters& counters) const {
  class Tracer final : public Worker {
   public:
    Tracer(const Scene& scene, const LightSources& sources, const PathSettings& settings, uint64_t seed,
           SampleCounters& counters)
        : sources_(sources),
          sampler_(scene.sampler(), hash_counters(seed, kLightStream)),
          splatter_(scene, settings, sampler_, counters),
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
  return std::make_unique<Tracer>(scene, *sources_, settings_, seed, counters);
}

IntegratorPlugin particle_tracer_row() {
  return {"ptracer",
          {},
          "light tracing: paths from the lights, joined with the sensor; cannot see through mirrors and smooth glass",
          with_common_parameters({}),
          [](const Properties& properties) {
            return IntegratorSetup{std::make_shared<ParticleTracer>(path_settings(properties)), false};
          }};
}

}  // namespace turbid
