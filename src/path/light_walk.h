#pragma once
#include "path/adjoint.h"
#include "path/light_sources.h"
#include "path/path_settings.h"
#include "path/traveller.h"

namespace turbid {

/// Where on its path light is: edges and collisions behind it, and its flux. An estimator that joins a vertex with
/// something else adds its own.
struct PathState {
  Spectrum throughput;  ///< flux before the event, W; no scattering of this vertex in it
  int depth;            ///< edges behind
  int order;            ///< collisions in media behind, with this one
};

/// A surface that light has arrived at.
struct SurfaceEvent {
  const Object& object;
  const SurfacePoint& point;
  Vec3 wi;        ///< unit, to where the light comes from
  Vec3 wi_local;  ///< the same in the shading frame
};

/// A collision that light scatters in.
struct CollisionEvent {
  Vec3 position;
  Vec3 direction;  ///< of the light before, unit
  const Medium& medium;
};

/// Light paths. The recorder, chosen at compile time, is told of every vertex:
///   at_emitter(const Emission&, const Traveller&)               before the first edge
///   at_surface(const SurfaceEvent&, const PathState&, const Traveller&)     only where both normals agree about wi
///   at_collision(const CollisionEvent&, const PathState&, const Traveller&) albedo and transmittance in the throughput
/// and, if it has this function, of every straight piece of flight in a medium:
///   at_segment(const Ray& from the start to the end, const Medium&, const PathState& at its start, bool collides)
/// The traveller stands at the vertex and can look along lines from there. Depths count edges and orders collisions as
/// in path tracing from the sensor; null surfaces cost nothing. Vertices are reported as long as one more edge is
/// allowed by max_depth and max_scattering; min_scattering and hide_emitters are left to the recorder.
template <class Recorder>
class LightWalk {
 public:
  LightWalk(const Scene& scene, const LightSources& sources, const PathSettings& settings, Sampler& sampler,
            SampleCounters& counters, Recorder& recorder)
      : scene_(scene),
        sources_(sources),
        settings_(settings),
        sampler_(sampler),
        counters_(counters),
        recorder_(recorder),
        traveller_(scene, true, sampler, counters) {}

  /// One path; its random numbers come from where the sampler stands.
  void run() {
    ++counters_.light_paths;
    if (settings_.max_depth <= 0) return;
    const std::optional<Emission> emission = sources_.sample(sampler_);
    if (!emission) return;
    throughput_ = emission->throughput;
    initial_ = throughput_.max();
    depth_ = order_ = 0;
    traveller_.start({emission->ray.origin, emission->ray.direction}, emission->medium, emission->media);
    recorder_.at_emitter(*emission, traveller_);
    if (settings_.max_depth < 2) return;
    while (true) {
      Hit hit;
      if (traveller_.medium()) {
        if (fly(hit)) {
          if (!scatter_in_medium()) return;
          continue;
        }
      } else {
        hit = traveller_.cast();
      }
      if (!hit || throughput_.is_black() || !arrive_at_surface(hit)) return;
    }
  }

 private:
  /// True: collides.
  bool fly(Hit& hit) {
    const Ray start = traveller_.ray();
    const Medium& medium = *traveller_.medium();
    const Traveller::Leg leg = traveller_.fly(throughput_);
    if constexpr (requires { &Recorder::at_segment; })
      recorder_.at_segment({start.origin, start.direction, leg.length}, medium, state(), leg.collides);
    throughput_ *= leg.weight;
    hit = leg.hit;
    return leg.collides;
  }

  PathState state() const { return {throughput_, depth_, order_}; }

  bool scatter_in_medium() {
    ++counters_.collisions;
    ++order_;
    if (++depth_ >= settings_.max_depth || order_ > settings_.max_scattering || throughput_.is_black()) return false;
    const Ray& ray = traveller_.ray();
    const Medium& medium = *traveller_.medium();
    recorder_.at_collision({ray.origin, ray.direction, medium}, state(), traveller_);
    const Vec2 u = sampler_.next_2d();
    traveller_.turn(direction_about(ray.direction, medium.phase().sample(u.x), 2 * kPi * u.y));
    return survives();
  }

  bool arrive_at_surface(const Hit& hit) {
    const Object& object = scene_.object(hit);
    const SurfacePoint point = object.shape->surface_point(traveller_.ray(), hit);
    if (traveller_.hides(object)) {
      traveller_.pass_surface(object, point, hit.t);
      return true;
    }
    const Bsdf& bsdf = *object.bsdf;
    const lobe::Flags flags = bsdf.flags();
    const Vec3 wi = -traveller_.ray().direction, wi_local = point.to_local(wi);
    if (flags == (lobe::kNull | lobe::kDelta | lobe::kTransmission)) {
      throughput_ *= bsdf.null_transmission(point, wi_local);
      traveller_.pass_surface(object, point, hit.t);
      return !throughput_.is_black();
    }

    const bool agreed = wi_local.z * dot(wi, point.ng) > 0;
    ++depth_;
    if (agreed && depth_ < settings_.max_depth)
      recorder_.at_surface({object, point, wi, wi_local}, state(), traveller_);
    const float u_lobe = sampler_.next_1d();
    const auto sample = bsdf.sample(point, wi_local, u_lobe, sampler_.next_2d(), TransportMode::kImportance);
    if (!sample) return false;
    throughput_ *= sample->weight;
    if (sample->flags & lobe::kNull) {
      --depth_;
      traveller_.pass_surface(object, point, hit.t);
      return !throughput_.is_black();
    }
    const Vec3 wo = point.to_world(sample->direction);
    throughput_ *= adjoint_correction(point, wi, wo);
    if (depth_ >= settings_.max_depth || throughput_.is_black()) return false;
    traveller_.leave(object, point, wo);
    return survives();
  }

  /// Russian roulette: survives with the share of the initial flux that is left.
  bool survives() {
    // The edge that would end here could still be joined with the sensor only if there is one more.
    if (depth_ + 1 >= settings_.max_depth) return false;
    if (depth_ < settings_.rr_depth) return true;
    float prob = std::min(1.0f, throughput_.max() / initial_);
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
  const LightSources& sources_;
  const PathSettings& settings_;
  Sampler& sampler_;
  SampleCounters& counters_;
  Recorder& recorder_;
  Traveller traveller_;

  Spectrum throughput_;
  float initial_ = 0;
  int depth_ = 0, order_ = 0;
};

}  // namespace turbid
