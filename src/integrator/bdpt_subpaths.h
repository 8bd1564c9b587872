#pragma once
#include <vector>

#include "integrator/refractive_gatherer.h"
#include "integrator/splatting_integrator.h"
#include "path/join.h"
#include "path/light_recorder.h"
#include "path/sensor_connector.h"

namespace turbid {

/// What the two subpaths of one worker share.
struct BdptContext {
  const Scene& scene;
  const LightSources& sources;
  const PathSettings& settings;
  const StrategyWeights& weights;
  float connections;  ///< BdptSettings::connections
  const SensorConnector& sensor;
  const RefractiveScattering* refraction;  ///< finds some of the light; null: subpaths find everything
  SampleCounters& counters;
};

/// The subpath from a light: keeps its vertices, and joins each with the sensor (t = 1).
class LightSubpath : public LightRecorder {
 public:
  explicit LightSubpath(const BdptContext& context)
      : LightRecorder(context.scene, context.weights),
        context_(context),
        counted_(RefractiveScattering::counted_light(context.refraction)) {}

  void begin(ContributionSink& sink) {
    sink_ = &sink;
    vertices_.clear();
  }
  const std::vector<Vertex>& vertices() const { return vertices_; }

  void at_emitter(const Emission& emission, const Traveller& traveller);
  void at_surface(const SurfaceEvent& event, const PathState& state, const Traveller& traveller);
  void at_collision(const CollisionEvent& event, const PathState& state, const Traveller& traveller);
  void left_surface(const SurfaceEvent& event, const BsdfSample& sample, const Vec3& chosen, const PathState& state,
                    const Traveller& traveller) {
    LightRecorder::left_surface(event, sample, chosen, state, traveller);
    counted_.left_surface(event, sample, traveller.medium_towards(event, chosen));
  }

 private:
  void join_with_sensor(const Vertex& vertex, const Traveller& traveller);

  const BdptContext& context_;
  CountedLight counted_;
  ContributionSink* sink_ = nullptr;
  std::vector<Vertex> vertices_;
};

/// The subpath from the sensor: at each vertex it asks for light (s = 1) and joins the vertices of a light subpath
/// (s >= 2); lights met by chance are s = 0.
class SensorSubpath : public SubpathRecorder<TransportMode::kRadiance> {
 public:
  SensorSubpath(const BdptContext& context, Sampler& sampler, const std::vector<Vertex>& light_vertices)
      : SubpathRecorder(context.weights), context_(context), sampler_(sampler), light_vertices_(light_vertices) {}

  /// `selection`: names the random choice of connections.
  void begin(const SensorRay& camera, uint64_t selection, ContributionSink& sink) {
    sink_ = &sink;
    u_aperture_ = camera.u_aperture;
    selection_ = Rng(selection);
    if (context_.refraction)
      refraction_.emplace(*context_.refraction, context_.scene, context_.settings, sampler_, context_.counters);
    start_edge();
  }

  void before_flight(const Medium& medium, const PathState& state, const Traveller& traveller);

  void on_segment(const Ray& way, const Medium& medium, const PathState& state, const Traveller::Leg& leg);
  void at_light(const Hit& hit, const Object& object, const SurfacePoint& point, const PathState& state,
                const Traveller& traveller);
  void at_escape(const PathState& state, const Traveller& traveller);
  void at_surface(const SurfaceEvent& event, const PathState& state, const Traveller& traveller);
  void at_collision(const CollisionEvent& event, const PathState& state, const Traveller& traveller);
  void left_surface(const SurfaceEvent& event, const BsdfSample& sample, const Vec3& chosen, const PathState& state,
                    const Traveller& traveller) {
    SubpathRecorder::left_surface(event, sample, chosen, state, traveller);
    if (refraction_) refraction_->left_surface(event, sample, traveller);
  }
  void left_collision(const CollisionEvent& event, float mu, const Vec3& chosen, const PathState& state,
                      const Traveller& traveller) {
    SubpathRecorder::left_collision(event, mu, chosen, state, traveller);
    if (refraction_) refraction_->left_collision(event, state);
  }

 protected:
  /// The sums where an edge ends that lets `straight` through; `depth`: edges up to there.
  StrategySums arrive(const EdgeEnd& end, int depth, const Spectrum& straight) const {
    return depth == 1 ? first_sums(end, straight) : edge_.sums_at(weights_, end, straight);
  }
  /// A vertex that the walk has arrived at.
  Vertex reach(const SurfaceEvent& event, const PathState& state, const Traveller& traveller);
  Vertex reach(const CollisionEvent& event, const PathState& state);
  /// Asks for light there, and joins it with the light's subpath.
  void connect(const Vertex& vertex, const Traveller& traveller);

  const BdptContext& context_;
  Sampler& sampler_;
  ContributionSink* sink_ = nullptr;

 private:
  StrategySums first_sums(const EdgeEnd& end, const Spectrum& straight) const;
  void gather(const Spectrum& value, double others, int light_vertices, int sensor_vertices, int order);
  void gather_by_chance(const Spectrum& value, double others, const PathState& state);
  void estimate_direct(const Vertex& vertex, const Traveller& traveller);
  double others_of_direct(const Vertex& vertex, const EmitterChoice& choice, const DirectLightSample& light,
                          const Vertex::Scattering& scattered, const Spectrum& proxy) const;
  void join(const Vertex& vertex, const Traveller& traveller);
  bool counted_elsewhere(bool environment) const { return refraction_ && refraction_->has_counted(environment); }
  bool visit_counts(const Vertex& vertex, const Vertex& light) const;

  const std::vector<Vertex>& light_vertices_;
  std::optional<RefractiveGatherer> refraction_;
  Vec2 u_aperture_;
  Rng selection_;
};

}  // namespace turbid
