#pragma once
#include "path/adjoint.h"
#include "path/events.h"
#include "path/light_sources.h"
#include "path/path_settings.h"
#include "path/traveller.h"

namespace turbid {

/// What a recorder may be told of; recorders derive from this and hide what they want to hear (no virtual calls: Walk
/// knows its recorder at compile time). The traveller stands at the vertex and can look along lines from there.
struct WalkRecorder {
  /// A path is about to leave its light, or the sensor (at the near plane).
  void at_emitter(const Emission&, const Traveller&) {}
  void at_sensor(const PathState&, const Traveller&) {}
  /// A flight through a medium is about to begin along the traveller's ray, wherever it will end.
  void before_flight(const Medium&, const PathState&, const Traveller&) {}
  /// A straight piece of flight in a medium, from the ray's origin to its t_max; the state is that at its start.
  void on_segment(const Ray&, const Medium&, const PathState&, const Traveller::Leg&) {}
  /// Asked before each flight: true, and the flight does not collide but passes with the transmittance of the way as
  /// its weight. on_passage hears of the way first (the state is that at its start, where the traveller still stands):
  /// the recorder makes the collisions.
  bool passes_media() const { return false; }
  void on_passage(const Ray&, const Medium&, const PathState&, const Traveller&) {}
  /// The walk went straight on: through a medium (Medium::proxy_transmittance of the way), or through a surface
  /// (Bsdf::null_transmission).
  void passed_medium(const Spectrum& /*proxy*/) {}
  void passed_surface(const Spectrum& /*through*/) {}
  /// A walk from the sensor met a surface that shines, or left the scene.
  void at_light(const Hit&, const Object&, const SurfacePoint&, const PathState&, const Traveller&) {}
  void at_escape(const PathState&, const Traveller&) {}
  /// A vertex from which the path may go on. Surfaces: only where both normals agree about the side of `given`.
  void at_surface(const SurfaceEvent&, const PathState&, const Traveller&) {}
  void at_collision(const CollisionEvent&, const PathState&, const Traveller&) {}
  /// The walk has chosen how it leaves the vertex (unit, away from it); the throughput holds the choice. Collisions: mu
  /// is the cosine of the deflection.
  void left_surface(const SurfaceEvent&, const BsdfSample&, const Vec3& /*chosen*/, const PathState&,
                    const Traveller&) {}
  void left_collision(const CollisionEvent&, float /*mu*/, const Vec3& /*chosen*/, const PathState&, const Traveller&) {
  }
  /// A visit to a medium ends at a point: the walk has gone through the boundary there, which is in the throughput, or
  /// has come to an opaque surface, which is not. `given` leads back into the medium; the state's visit is the one that
  /// ends.
  void left_medium(const Object&, const SurfacePoint&, const Vec3& /*given*/, const PathState&) {}
  /// Asked after each vertex: false ends the walk there.
  bool goes_on() const { return true; }
};

/// A random path through the scene from one of its ends: TransportMode::kRadiance from the sensor, kImportance from a
/// light. Both share everything but what they carry (the scaling of radiance at refractive boundaries, the correction
/// for shading normals) and how they begin. kSeesMedia false: media are ignored, and passing straight through a surface
/// is an event like any other.
///
/// Depths count edges and orders collisions (all of them, and those of the visit to a medium); with media, null
/// surfaces cost nothing. Vertices are reported as long as max_depth allows one more edge and max_scattering their
/// order; min_scattering and hide_emitters are left to the recorder.
template <TransportMode kMode, bool kSeesMedia, class Recorder>
class Walk {
 public:
  Walk(const Scene& scene, const PathSettings& settings, Sampler& sampler, SampleCounters& counters, Recorder& recorder)
      : scene_(scene),
        settings_(settings),
        sampler_(sampler),
        counters_(counters),
        recorder_(recorder),
        traveller_(scene, kSeesMedia, sampler, counters) {}

  /// Walks from the sensor. The recorder hears nothing of what lies before the near plane. Returns alpha: 1 where the
  /// walk met anything but empty space, media included.
  float run(const SensorRay& camera) requires(kMode == TransportMode::kRadiance) {
    return run(camera, scene_.sensor_medium(), scene_.sensor_media());
  }
  /// The same for a ray that begins elsewhere: in `medium`, or in scenes with priorities inside of the shapes
  /// `enclosing`.
  float run(const SensorRay& camera, const Medium* medium,
            const MediumStack& enclosing) requires(kMode == TransportMode::kRadiance) {
    throughput_ = Spectrum(camera.weight);
    inverse_start_ = eta_scale_ = 1;
    depth_ = order_ = visit_order_ = 0;
    alpha_ = 0;
    if (settings_.max_depth <= 0) return alpha_;
    traveller_.start(camera.ray, medium, enclosing);
    if (camera.near_t > 0) {
      if (const Medium* near = traveller_.medium())
        throughput_ *= near->transmittance({camera.ray.origin, camera.ray.direction, camera.near_t}, sampler_);
      traveller_.skip(camera.near_t);
    }
    recorder_.at_sensor(state(), traveller_);
    follow();
    return alpha_;
  }

  /// Walks from a light; its random numbers come from where the sampler stands.
  void run(const LightSources& sources) requires(kMode == TransportMode::kImportance) {
    ++counters_.light_paths;
    if (settings_.max_depth <= 0) return;
    const std::optional<Emission> emission = sources.sample(sampler_);
    if (!emission) return;
    throughput_ = emission->throughput;
    inverse_start_ = 1 / throughput_.max();
    depth_ = order_ = visit_order_ = 0;
    traveller_.start({emission->ray.origin, emission->ray.direction}, emission->medium, emission->media);
    recorder_.at_emitter(*emission, traveller_);
    if (settings_.max_depth >= 2) follow();
  }

 private:
  static constexpr bool kFromLight = kMode == TransportMode::kImportance;

  PathState state() const { return {throughput_, depth_, order_, visit_order_}; }
  /// At the end of the edge that is being walked.
  PathState state_ahead() const { return {throughput_, depth_ + 1, order_, visit_order_}; }

  void follow() {
    while (true) {
      Hit hit;
      if (kSeesMedia && traveller_.medium()) {
        if (fly(hit)) {
          if (!scatter_in_medium()) return;
          continue;
        }
      } else {
        hit = traveller_.cast();
      }
      if (!hit) {
        // The sky is something to see, too.
        if (!kFromLight && !scene_.environments().empty() && !(depth_ == 0 && settings_.hide_emitters)) alpha_ = 1;
        recorder_.at_escape(state_ahead(), traveller_);
        return;
      }
      if (kFromLight && throughput_.is_black()) return;
      if (!arrive_at_surface(hit)) return;
    }
  }

  /// Through a medium; true: collides.
  bool fly(Hit& hit) {
    const Ray start = traveller_.ray();
    const Medium& medium = *traveller_.medium();
    recorder_.before_flight(medium, state(), traveller_);
    const bool passes = recorder_.passes_media();
    const Traveller::Leg leg = passes ? traveller_.pass() : traveller_.fly(throughput_);
    const Ray way{start.origin, start.direction, leg.length};
    if (passes) recorder_.on_passage(way, medium, state(), traveller_);
    recorder_.on_segment(way, medium, state(), leg);
    throughput_ *= leg.weight;
    hit = leg.hit;
    if (!leg.collides) recorder_.passed_medium(leg.proxy);
    return leg.collides;
  }

  bool scatter_in_medium() {
    ++counters_.collisions;
    alpha_ = 1;
    ++order_;
    ++visit_order_;
    if (++depth_ >= settings_.max_depth || order_ > settings_.max_scattering || throughput_.is_black()) return false;
    if (!settings_.visit_counts(traveller_.medium(), visit_order_)) return false;
    const CollisionEvent event{traveller_.ray().origin, traveller_.ray().direction, *traveller_.medium()};
    recorder_.at_collision(event, state(), traveller_);
    const Vec2 u = sampler_.next_2d();
    const float mu = event.medium.phase().sample(u.x);
    const Vec3 chosen = direction_about(event.direction, mu, 2 * kPi * u.y);
    traveller_.turn(chosen);
    recorder_.left_collision(event, mu, chosen, state(), traveller_);
    return survives();
  }

  bool arrive_at_surface(const Hit& hit) {
    const Object& object = scene_.object(hit);
    const SurfacePoint point = object.shape->surface_point(traveller_.ray(), hit);
    if (traveller_.hides(object)) {
      pass_surface(object, point, hit.t);
      return true;
    }
    if (!kFromLight && object.emitter) recorder_.at_light(hit, object, point, state_ahead(), traveller_);

    const Bsdf& bsdf = *object.bsdf;
    const Vec3 given = -traveller_.ray().direction;
    const SurfaceEvent event{object, point, given, point.to_local(given)};
    if (kSeesMedia && bsdf.flags() == (lobe::kNull | lobe::kDelta | lobe::kTransmission))
      return pass_straight(event, hit.t, bsdf.null_transmission(point, event.given_local));

    // Both normals must agree about the side; where they do not there is no transport, seen from either end.
    const bool agreed = event.given_local.z * dot(given, point.ng) > 0;
    ++depth_;
    if (agreed && depth_ < settings_.max_depth) recorder_.at_surface(event, state(), traveller_);
    if (!(bsdf.flags() & lobe::kTransmission)) recorder_.left_medium(object, point, given, state());
    const float u_lobe = sampler_.next_1d();
    const auto sample = bsdf.sample(point, event.given_local, u_lobe, sampler_.next_2d(), kMode);
    const bool straight = sample && sample->flags & lobe::kNull;
    if (!kSeesMedia || !straight) alpha_ = 1;
    if (!sample) return false;
    if (kSeesMedia && straight) {
      --depth_;
      recorder_.passed_surface(bsdf.null_transmission(point, event.given_local));
      throughput_ *= sample->weight;
      pass_surface(object, point, hit.t);
      return !throughput_.is_black();
    }
    const Vec3 chosen = point.to_world(sample->direction);
    if (!straight && (!agreed || sample->direction.z * dot(chosen, point.ng) <= 0)) return false;
    throughput_ *= sample->weight;
    if constexpr (kFromLight)
      throughput_ *= adjoint_correction(point, given, chosen);
    else
      eta_scale_ *= sqr(sample->eta);
    if (sample->flags & lobe::kTransmission) recorder_.left_medium(object, point, given, state());
    if (!(sample->flags & lobe::kReflection && keeps_visit(bsdf))) visit_order_ = 0;
    traveller_.leave(object, point, chosen);
    recorder_.left_surface(event, *sample, chosen, state(), traveller_);
    if (depth_ >= settings_.max_depth || throughput_.is_black()) return false;
    return survives();
  }

  /// Goes straight on behind a surface: no event, the last scattering stays the one that chose this direction.
  bool pass_straight(const SurfaceEvent& event, float t, const Spectrum& through) {
    recorder_.passed_surface(through);
    throughput_ *= through;
    pass_surface(event.object, event.point, t);
    return !kFromLight || !throughput_.is_black();
  }

  /// Another medium behind the surface is another visit.
  void pass_surface(const Object& object, const SurfacePoint& point, float t) {
    const Medium* before = traveller_.medium();
    traveller_.pass_surface(object, point, t);
    if (traveller_.medium() == before) return;
    recorder_.left_medium(object, point, -traveller_.ray().direction, state());
    visit_order_ = 0;
  }

  /// Russian roulette: survives with the share of the initial flux or importance that is left (but for the scaling of
  /// radiance in matter), so that all survivors weigh alike.
  bool survives() {
    if (!recorder_.goes_on()) return false;
    // The edge that would end here could still be joined with the sensor only if there is one more.
    if (kFromLight && depth_ + 1 >= settings_.max_depth) return false;
    if (depth_ < settings_.rr_depth) return true;
    float prob = std::min(1.0f, throughput_.max() * eta_scale_ * inverse_start_);
    // A path can be trapped without loss (total reflection, albedo 1): beyond any sensible length it must end some
    // time.
    if (depth_ > kTrappedDepth) prob = std::min(prob, 0.95f);
    if (prob >= 1) return true;
    if (sampler_.next_1d() >= prob) return false;
    throughput_ /= prob;
    return true;
  }
  static constexpr int kTrappedDepth = 1 << 14;

  const Scene& scene_;
  const PathSettings& settings_;
  Sampler& sampler_;
  SampleCounters& counters_;
  Recorder& recorder_;
  Traveller traveller_;

  Spectrum throughput_{1.0f};
  float inverse_start_ = 1;  ///< 1 / largest channel of the throughput at the start
  float eta_scale_ = 1;      ///< squared index here / at the sensor, for walks from there
  float alpha_ = 0;
  int depth_ = 0, order_ = 0;
  int visit_order_ = 0;  ///< PathState::visit_order
};

template <class Recorder>
using LightWalk = Walk<TransportMode::kImportance, true, Recorder>;
template <class Recorder, bool kSeesMedia = true>
using CameraWalk = Walk<TransportMode::kRadiance, kSeesMedia, Recorder>;

}  // namespace turbid
