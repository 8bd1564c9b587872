#pragma once
#include <optional>

#include "integrator/splatting_integrator.h"
#include "path/connection_sampler.h"
#include "path/sensor_connector.h"
#include "path/subpath.h"

namespace turbid {

/// Joins light paths with the sensor by collisions that the walk finds or that are made for it (ConnectionSampler: x0
/// is a vertex of the walk, x2 a point of the aperture). Where the sensor has no aperture the walk makes them all.
class LightSplatter : public EdgeRecorder {
 public:
  LightSplatter(const Scene& scene, const PathSettings& settings, const ConnectionSettings& connection,
                const Sampler& sampler, SampleCounters& counters);

  void begin(ContributionSink& sink) { sink_ = &sink; }

  void at_emitter(const Emission& emission, const Traveller& traveller);
  void at_surface(const SurfaceEvent& event, const PathState& state, const Traveller& traveller);
  void at_collision(const CollisionEvent& event, const PathState& state, const Traveller& traveller);
  void left_surface(const SurfaceEvent& event, const BsdfSample& sample, const Vec3& chosen, const PathState& state,
                    const Traveller& traveller);
  void left_collision(const CollisionEvent& event, float mu, const Vec3& chosen, const PathState& state,
                      const Traveller& traveller);

 private:
  /// Flux per solid angle that leaves x0 in a direction, W/sr, and the density with which the walk goes there, 1/sr.
  struct Leaving {
    Vec3 origin;
    Spectrum flux;
    float pdf_w = 0;
  };
  bool may_insert(const PathState& state) const;
  PathEnd end_at(const Vec2& u_aperture) const {
    return {*scene_.sensor().aperture_point(u_aperture), false, connector_.view_from(u_aperture)};
  }
  void join_with_sensor(const Vertex& vertex, bool shared, const Traveller& traveller);
  void insert_from_vertex(const Vertex& vertex, const PathState& state, const Traveller& traveller);
  /// Once more: `leave(direction)` says what leaves x0, as Leaving.
  template <class Leave>
  void insert_from(const Vec3& x0, const PathState& state, const Traveller& traveller, const SurfaceEvent* surface,
                   const Leave& leave);
  void depart(const Departure& from, const PathState& state, const Traveller& traveller);
  void finish(const Vec3& x1, const Medium& medium, const Spectrum& arrived, const SensorConnection& way, double factor,
              const PathState& state);
  void splat(const SensorArrival& arrival, const Spectrum& flux, double weight_here, const PathState& state, int added);

  const Scene& scene_;
  const PathSettings& settings_;
  ConnectionSampler maker_;
  const Sampler& sampler_;
  SensorConnector connector_;
  ContributionSink* sink_ = nullptr;

  const Medium* expected_ = nullptr;  ///< at the vertex where the walk is, see ConnectionSampler::expected
  Departure last_;                    ///< of the edge that the walk is on
};

}  // namespace turbid
