#pragma once
#include <optional>

#include "integrator/splatting_integrator.h"
#include "path/once_more.h"
#include "path/sensor_connector.h"
#include "path/subpath.h"

namespace turbid {

/// How the last collision x1 before the sensor is found, given the vertex x0 before it.
enum class CameraConnection {
  kStandard,     ///< by the walk: the direction by scattering at x0, the distance by a free flight
  kEquiangular,  ///< the direction by scattering, the distance equiangularly about the sensor (Kulla & Fajardo 2012)
  kOnceMore,     ///< inserted between x0 and the sensor (S3)
  kMis,          ///< all of these, weighted by the power heuristic
};

struct CameraConnectionSettings {
  CameraConnection technique = CameraConnection::kStandard;
  Insertion insertion = Insertion::kAngle;  ///< of collisions that are inserted
};

/// Joins light paths with the sensor by collisions that are made for it. Three techniques make x1; their densities per
/// volume are known for any x1, so that they can share it:
///   walk          p_w(x0 -> x1) / d1^2 times the density of a free flight (a stand-in that depends on the edge alone)
///   equiangular   p_w(x0 -> x1) / d1^2 times D / (angle (D^2 + (t - delta)^2))
///   once more     insertion_pdf_v
/// They apply where x0 leaves its direction open (no laser, sky, mirror or smooth glass), where the medium at x1
/// scatters as the one at x0 (the same phase function), to sensors with an aperture, and in scenes without priorities;
/// everywhere else the walk alone makes x1, with weight 1.
class LightSplatter : public EdgeRecorder {
 public:
  LightSplatter(const Scene& scene, const PathSettings& settings, const CameraConnectionSettings& connection,
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
  /// The densities of x1 by the three techniques, per volume; 0 where one does not apply.
  struct Densities {
    double walk = 0, equiangular = 0, once_more = 0;
  };
  enum class Technique { kWalk, kEquiangular, kOnceMore };

  /// The phase function for collisions inserted from a vertex in this medium, or null where none can be.
  const PhaseFunction* phase_around(const Medium* medium) const;
  const PhaseFunction* phase_around(const Object& object, const Medium* medium) const;
  bool may_insert(const PathState& state) const;
  bool scatters_as_here(const Passage& passage) const;
  Densities densities(const PhaseFunction& phase, const Vec3& x0, const Vec3& x1, const Vec3& x2, float pdf_w,
                      const Spectrum& sigma, const Spectrum& proxy) const;
  double weight(Technique technique, const Densities& densities) const;

  void join_with_sensor(const Vertex& vertex, const PhaseFunction* shared, const Traveller& traveller);
  void insert_from_vertex(const Vertex& vertex, const PathState& state, const Traveller& traveller);
  /// Once more: `leave(direction)` says what leaves x0, as Leaving.
  template <class Leave>
  void insert_from(const Vec3& x0, const PathState& state, const Traveller& traveller, const SurfaceEvent* surface,
                   const Leave& leave);
  void depart(const Vec3& x0, float pdf_w, const PathState& state, const Traveller& traveller);
  void finish(const Vec3& x1, const Medium& medium, const Spectrum& arrived, const SensorConnection& way, double factor,
              const PathState& state);
  void splat(const SensorArrival& arrival, const Spectrum& flux, double weight_here, const PathState& state, int added);

  const Scene& scene_;
  const PathSettings& settings_;
  CameraConnection connection_;
  Insertion insertion_;
  const Sampler& sampler_;
  SensorConnector connector_;
  ContributionSink* sink_ = nullptr;

  const PhaseFunction* current_phase_ = nullptr;  ///< at the vertex where the walk is, see phase_around
  Vec3 last_position_;                            ///< x0 of the edge that the walk is on ...
  float last_pdf_w_ = 0;                          ///< ... and how it was left, 1/sr
  const PhaseFunction* last_phase_ = nullptr;     ///< null: no other technique makes the end of this edge
};

}  // namespace turbid
