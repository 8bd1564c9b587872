#pragma once
#include "integrator/camera_sample.h"
#include "integrator/refractive_gatherer.h"
#include "path/connection_sampler.h"
#include "path/walk.h"

namespace turbid {

/// Gathers the light that a walk from the sensor finds: by chance, by next-event estimation at every vertex, and by
/// collisions that are made for a light (ConnectionSampler: x0 is a vertex of the walk, the sensor included, x2 a point
/// of a light that sample_direct(x0) chose).
///
/// Techniques share a path in two steps. At the last vertex next-event estimation and light met by chance are weighted
/// against each other (power heuristic). Where that vertex is a collision x1 that others could have made, both are
/// weighted together against those others, the density of x2 in solid angle at x1.
class LightGatherer : public WalkRecorder {
 public:
  /// `refraction` may be null.
  LightGatherer(const Scene& scene, const PathSettings& settings, const ConnectionSettings& connection,
                const RefractiveScattering* refraction, Sampler& sampler, SampleCounters& counters)
      : scene_(scene), settings_(settings), maker_(scene, connection), sampler_(sampler), counters_(counters) {
    if (refraction) refraction_.emplace(*refraction, scene, settings, sampler, counters);
  }

  const PixelSample& result() const { return result_; }

  void before_flight(const Medium& medium, const PathState& state, const Traveller& traveller) {
    if (refraction_) add(1, refraction_->before_flight(medium, state, traveller));
  }
  void on_segment(const Ray& way, const Medium& medium, const PathState& state, const Traveller::Leg& leg) {
    if (maker_.active() && leg.collides) proxy_ *= medium.proxy_transmittance(way);
    if (medium.emits() && (state.depth > 0 || !settings_.hide_emitters)) gather(state, leg.emission);
  }
  void passed_medium(const Spectrum& proxy) {
    const Spectrum passed = straight_ * proxy;
    if (!straight_.is_black()) passing_prob_ *= passed.sum() / straight_.sum();
    straight_ = passed;
    proxy_ *= proxy;
  }
  void passed_surface(const Spectrum& through) {
    passing_prob_ *= null_prob(through);
    straight_ *= through;
    proxy_ *= through;
  }

  void at_sensor(const PathState& state, const Traveller& traveller);
  void at_collision(const CollisionEvent& event, const PathState& state, const Traveller& traveller);
  void left_collision(const CollisionEvent& event, float mu, const Vec3&, const PathState& state,
                      const Traveller& traveller);
  void at_surface(const SurfaceEvent& event, const PathState& state, const Traveller& traveller);
  void left_surface(const SurfaceEvent& event, const BsdfSample& sample, const Vec3& chosen, const PathState& state,
                    const Traveller& traveller);
  void at_light(const Hit& hit, const Object& object, const SurfacePoint& point, const PathState& state,
                const Traveller& traveller);
  void at_escape(const PathState& state, const Traveller& traveller);

 protected:
  void add(int order, const Spectrum& light) {
    result_.radiance += light;
    result_.by_order[std::min(order, kOrderClasses - 1)] += light;
  }

 private:
  /// A point of a light, as the vertex sees it that it was chosen from.
  struct LightEnd {
    EmitterChoice choice;
    DirectLightSample sample;
  };

  /// Begins a new edge whose direction was chosen with density pdf_w; 0: no other technique can choose it.
  void set_out(const Vec3& position, float pdf_w, const Spectrum& throughput) {
    last_position_ = position;
    last_pdf_w_ = pdf_w;
    passing_prob_ = 1;
    straight_ = throughput;
  }

  bool counted_elsewhere(bool environment) const { return refraction_ && refraction_->has_counted(environment); }

  /// Of light met by chance at the end of the edge: its weight against next-event estimation, times share_of_walk.
  float hit_weight(const EmitterChoice& choice, const DirectLightSample& light) const;
  /// The share of next-event estimation and of light met by chance in a path whose last edges are `arrival` and one to
  /// the light, seen from x1. `hit_pdf_w`: of the direction to it by chance, 1/sr; 0: never.
  float share_of_walk(const Edge& arrival, const EmitterChoice& choice, const DirectLightSample& light,
                      float hit_pdf_w) const;

  void gather(const PathState& state, const Spectrum& value) {
    if (settings_.order_counts(state.order)) add(state.order, state.throughput * value);
  }

  /// Next-event estimation: one light, one point on it. `scatter(wi)` gives the value of the scattering and its
  /// density.
  template <class Scatter>
  void estimate_direct(const Vec3& from, const PathState& state, const Traveller& traveller, const Scatter& scatter,
                       const SurfaceEvent* surface = nullptr);

  // Collisions made for a light. The numbers are drawn whether the order counts or not, so that filters change nothing
  // else.
  bool may_insert(const PathState& state) const {
    return state.depth + 2 <= settings_.max_depth && settings_.order_counts(state.order + 1);
  }
  std::optional<LightEnd> choose_end(const Vec3& from);
  void insert_from(const Vertex& vertex, const PathState& state, const Traveller& traveller);
  void depart(const Departure& from, const PathState& state, const Traveller& traveller);
  void finish(const CollisionEvent& x1, const LightEnd& light, const Spectrum& arrived, double factor,
              CollisionDensities all, double CollisionDensities::*own, const PathState& state);

  const Scene& scene_;
  const PathSettings& settings_;
  ConnectionSampler maker_;
  Sampler& sampler_;
  SampleCounters& counters_;

  std::optional<RefractiveGatherer> refraction_;  ///< empty: paths find everything
  PixelSample result_{Spectrum(0.0f), 0};
  Vec3 last_position_;      ///< where the current direction was chosen ...
  float last_pdf_w_ = 0;    ///< ... and its density, 1/sr; 0 where next-event estimation could not have found its way
  float passing_prob_ = 1;  ///< see Passage::prob
  /// The throughput when the current edge began, times what pass_straight would multiply it by on the same way.
  Spectrum straight_{1.0f};

  // Only where other techniques make collisions.
  Spectrum proxy_{1.0f};              ///< of the edge so far (Passage::proxy)
  Departure departure_;               ///< of that edge
  const Medium* expected_ = nullptr;  ///< at the vertex where the walk is, see ConnectionSampler::expected
  Edge arrival_;                      ///< to that vertex (medium null: no other technique makes it) ...
  Edge last_arrival_;                 ///< ... and to the one where the edge began
};

}  // namespace turbid
