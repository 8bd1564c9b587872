#pragma once
#include <optional>

#include "integrator/integrator_plugin.h"
#include "path/traveller.h"
#include "refraction/refractive_scattering.h"

namespace turbid {

/// The parameter `single_scattering` of integrators that can add RefractiveScattering, and what it says: empty, paths
/// find everything.
Parameter single_scattering_parameter();
std::optional<RefractiveSettings> refraction_settings(const Properties& properties);

/// Adds the single scattering that RefractiveScattering finds to a walk from the sensor, and tells which light the walk
/// must not count a second time. What a recorder hears of its walk it passes on.
class RefractiveGatherer {
 public:
  RefractiveGatherer(const RefractiveScattering& scattering, const Scene& scene, const PathSettings& settings,
                     const Sampler& sampler, SampleCounters& counters)
      : scattering_(scattering),
        scene_(scene),
        settings_(settings),
        sampler_(sampler),
        counters_(counters),
        path_(scattering.counted_path()) {}

  /// The radiance of order 1 that the flight brings, times the throughput.
  Spectrum before_flight(const Medium& medium, const PathState& state, const Traveller& traveller) const {
    constexpr int kEdgesToTheLight = 3;  // to V, to P, to the light
    if (state.order > 0 || !settings_.order_counts(1)) return Spectrum(0.0f);
    if (state.depth > settings_.max_depth - kEdgesToTheLight || state.throughput.is_black()) return Spectrum(0.0f);
    Ray flight = traveller.ray();
    ++counters_.rays;
    const Hit hit = scene_.rays().intersect(flight);
    flight.t_max = hit ? hit.t : std::min(flight.t_max, scene_.distance_to_world_end(flight));
    return state.throughput * scattering_.gather(flight, medium, state.throughput, sampler_, counters_);
  }

  void left_collision(const CollisionEvent& event, const PathState& state) {
    path_.collided(event.medium, state.order);
  }
  void left_surface(const SurfaceEvent& event, const BsdfSample& sample, const Traveller& traveller) {
    path_.left_surface(event, sample, traveller.medium_towards(event, event.given));
  }
  /// The light that the walk has come to is counted by before_flight.
  bool has_counted(bool environment) const { return path_.is_counted(environment); }

 private:
  const RefractiveScattering& scattering_;
  const Scene& scene_;
  const PathSettings& settings_;
  const Sampler& sampler_;
  SampleCounters& counters_;
  CountedPath path_;
};

}  // namespace turbid
