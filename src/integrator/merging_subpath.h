#pragma once
#include "gathering/sensor_gatherer.h"
#include "integrator/bdpt_subpaths.h"
#include "integrator/entering_lights.h"
#include "photon/photon_gatherer.h"

namespace turbid {

/// The subpath from the sensor that is merged with photons wherever it can be, beside what SensorSubpath does.
class MergingSubpath : public SensorSubpath {
 public:
  /// `long_flights`: reach to the next surface, with the transmittance as weight; else they end where the walk
  /// collides. `entering`: what tables begin with, `table_samples` of which are asked for at each first collision of a
  /// visit; null without tables.
  MergingSubpath(const BdptContext& context, Sampler& sampler, const std::vector<Vertex>& light_vertices,
                 const PhotonGatherer& gatherer, bool long_flights, const EnteringLights* entering, int table_samples,
                 MergeWork& work)
      : SensorSubpath(context, sampler, light_vertices),
        gatherer_(gatherer),
        long_flights_(long_flights),
        entering_(entering),
        table_samples_(table_samples),
        work_(work) {}

  void on_segment(const Ray& way, const Medium& medium, const PathState& state, const Traveller::Leg& leg) {
    const HomogeneousMedium* homogeneous = medium.as_homogeneous();
    if (homogeneous && gatherer_.gathers_along_flights()) merge_along(way, *homogeneous, state, leg);
    SensorSubpath::on_segment(way, medium, state, leg);
  }
  void at_surface(const SurfaceEvent& event, const PathState& state, const Traveller& traveller) {
    const Vertex vertex = reach(event, state, traveller);
    if (!(event.object.bsdf->flags() & lobe::kSmooth)) return;
    connect(vertex, traveller);
    gatherer_.at(vertex, *sink_, work_);
  }
  void at_collision(const CollisionEvent& event, const PathState& state, const Traveller& traveller) {
    const Vertex vertex = reach(event, state);
    connect(vertex, traveller);
    gatherer_.at(vertex, *sink_, work_);
    if (!entering_) return;
    Rng rng = sampler_.aside(Purpose::kTableAtCollision, event.position, event.direction);
    const LightByOrder found = entering_->at_collision(event, state, table_samples_, rng);
    for (int order = 0; order < kOrderClasses; ++order)
      if (!found.light[order].is_black())
        sink_->gather(
            {.value = found.light[order], .light_vertices = 1, .sensor_vertices = vertex.depth + 1, .order = order});
  }

 private:
  void merge_along(const Ray& way, const HomogeneousMedium& medium, const PathState& state, const Traveller::Leg& leg) {
    const PathSettings& settings = context_.settings;
    if (state.depth + 2 > settings.max_depth || state.order + 1 > settings.max_scattering) return;
    if (medium.sigma_s().is_black() || state.throughput.is_black()) return;
    LightSegment segment{way, state.throughput, long_flights_, channel_mix(state.throughput)};
    if (long_flights_ && leg.collides)
      segment.ray.t_max = length_to_surface(context_.scene, way, medium, context_.counters);
    const auto sums_at = [&](float t) {
      return arrive({way.at(t), medium.sigma_t(), 1}, state.depth + 1, straight_ * medium.transmittance(t));
    };
    gatherer_.along({segment, medium, state.depth, state.order, state.visit_order}, sums_at, *sink_, work_);
  }

  const PhotonGatherer& gatherer_;
  bool long_flights_;
  const EnteringLights* entering_;
  int table_samples_;
  MergeWork& work_;
};

}  // namespace turbid
