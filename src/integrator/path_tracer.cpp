#include "integrator/path_tracer.h"

#include "path/traveller.h"

namespace turbid {
namespace {

/// Power heuristic with exponent 2 (Veach 1997, sect. 9.2.3) for one sample of each of two techniques.
float mis_weight(float pdf, float other_pdf) {
  if (pdf == 0) return 0;
  const float ratio = other_pdf / pdf;
  return 1 / (1 + ratio * ratio);
}

/// One path, as it grows. kVolumes: see PathTracer::Kind.
template <bool kVolumes>
class Walk {
 public:
  Walk(const Scene& scene, const PathSettings& settings, Sampler& sampler, SampleCounters& counters)
      : scene_(scene),
        settings_(settings),
        sampler_(sampler),
        counters_(counters),
        traveller_(scene, kVolumes, sampler, counters) {}

  PixelSample run(const SensorRay& camera) {
    if (settings_.max_depth <= 0) return {Spectrum(0.0f), 0};
    begin(camera);
    while (true) {
      Hit hit;
      if (kVolumes && traveller_.medium()) {
        if (fly(hit)) {
          if (!scatter_in_medium()) break;
          continue;
        }
      } else {
        hit = traveller_.cast();
      }
      if (!hit) {
        add_environment();
        break;
      }
      if (!arrive_at_surface(hit)) break;
    }
    PixelSample sample{radiance_, alpha_};
    std::copy(std::begin(by_order_), std::end(by_order_), sample.by_order);
    return sample;
  }

 private:
  void begin(const SensorRay& camera) {
    throughput_ = Spectrum(camera.weight);
    traveller_.start(camera.ray, scene_.sensor_medium(), scene_.sensor_media());
    if (camera.near_t > 0) {
      if (const Medium* medium = traveller_.medium())
        throughput_ *= medium->transmittance({camera.ray.origin, camera.ray.direction, camera.near_t}, sampler_);
      traveller_.skip(camera.near_t);
    }
    last_position_ = traveller_.ray().origin;
  }

  /// Through a medium; true: collides.
  bool fly(Hit& hit) {
    const bool glows = traveller_.medium()->emits() && (depth_ > 0 || !settings_.hide_emitters);
    const Traveller::Leg leg = traveller_.fly(throughput_);
    if (glows) add(leg.emission);
    throughput_ *= leg.weight;
    if (leg.collides) return true;
    hit = leg.hit;
    const Spectrum passed = straight_ * leg.proxy;
    passing_prob_ *= passed.sum() / straight_.sum();
    straight_ = passed;
    return false;
  }

  // --- events -------------------------------------------------------------------------------------------------------

  bool scatter_in_medium() {
    ++counters_.collisions;
    alpha_ = 1;
    ++order_;
    if (++depth_ >= settings_.max_depth || order_ > settings_.max_scattering || throughput_.is_black()) return false;
    const PhaseFunction& phase = traveller_.medium()->phase();
    const Ray arrived = traveller_.ray();
    if (!traveller_.blind()) {
      estimate_direct(arrived.origin, [&](const Vec3& wi) {
        const float f = phase.eval(dot(arrived.direction, wi));
        return Bsdf::Eval{Spectrum(f), f};
      });
    }
    const Vec2 u = sampler_.next_2d();
    const float mu = phase.sample(u.x);
    traveller_.turn(direction_about(arrived.direction, mu, 2 * kPi * u.y));
    set_out(traveller_.blind() ? 0 : phase.eval(mu));
    return survives();
  }

  bool arrive_at_surface(const Hit& hit) {
    const Object& object = scene_.object(hit);
    const SurfacePoint point = object.shape->surface_point(traveller_.ray(), hit);
    if (traveller_.hides(object)) {
      pass_surface(object, point, hit.t, Spectrum(1.0f));
      return true;
    }
    if (object.emitter) add_emission(*object.emitter, scene_.emitter_prob(hit), point);

    const Bsdf& bsdf = *object.bsdf;
    const lobe::Flags flags = bsdf.flags();
    const Vec3 wo = -traveller_.ray().direction, wo_local = point.to_local(wo);
    if (kVolumes && flags == (lobe::kNull | lobe::kDelta | lobe::kTransmission)) {
      const Spectrum through = bsdf.null_transmission(point, wo_local);
      pass_surface(object, point, hit.t, through);
      throughput_ *= through;
      return true;
    }

    // Both normals must agree about the side; where they do not there is no transport, seen from either end.
    const bool agreed = wo_local.z * dot(wo, point.ng) > 0;
    if (agreed && (flags & lobe::kSmooth) && depth_ + 1 < settings_.max_depth) {
      estimate_direct_at_surface(object, point, wo_local);
    }
    const float u_lobe = sampler_.next_1d();
    const auto sample = bsdf.sample(point, wo_local, u_lobe, sampler_.next_2d(), TransportMode::kRadiance);
    if (!sample) return false;
    if (kVolumes && (sample->flags & lobe::kNull)) {
      pass_surface(object, point, hit.t, bsdf.null_transmission(point, wo_local));
      throughput_ *= sample->weight;
      return !throughput_.is_black();
    }
    const Vec3 wi = point.to_world(sample->direction);
    const bool straight = sample->flags & lobe::kNull;
    if (!straight && (!agreed || sample->direction.z * dot(wi, point.ng) <= 0)) return false;
    alpha_ = 1;
    throughput_ *= sample->weight;
    eta_scale_ *= sqr(sample->eta);
    traveller_.leave(object, point, wi);
    set_out(sample->pdf_w);
    if (++depth_ >= settings_.max_depth || throughput_.is_black()) return false;
    return survives();
  }

  /// Goes straight on behind a surface: no event, the last scattering stays the one that chose this direction.
  void pass_surface(const Object& object, const SurfacePoint& point, float t, const Spectrum& through) {
    passing_prob_ *= null_prob(through);
    straight_ *= through;
    traveller_.pass_surface(object, point, t);
  }

  /// Begins a new edge whose direction was chosen with density pdf_w; 0: no other technique can choose it.
  void set_out(float pdf_w) {
    last_position_ = traveller_.ray().origin;
    last_pdf_w_ = pdf_w;
    passing_prob_ = 1;
    straight_ = throughput_;
  }

  /// Russian roulette: survives with the share of the initial importance that is left, so that all survivors weigh
  /// alike.
  bool survives() {
    if (depth_ < settings_.rr_depth) return true;
    float prob = std::min(1.0f, throughput_.max() * eta_scale_);
    // A path can be trapped without loss (total reflection, albedo 1): beyond any sensible length it must end some
    // time.
    if (depth_ > kTrappedDepth) prob = std::min(prob, 0.95f);
    if (prob >= 1) return true;
    if (sampler_.next_1d() >= prob) return false;
    throughput_ /= prob;
    return true;
  }
  static constexpr int kTrappedDepth = 1 << 14;

  // --- light --------------------------------------------------------------------------------------------------------

  bool order_counts() const { return settings_.order_counts(order_); }

  void add(const Spectrum& value) {
    if (order_counts()) gather(throughput_ * value);
  }

  void gather(const Spectrum& light) {
    radiance_ += light;
    by_order_[std::min(order_, kOrderClasses - 1)] += light;
  }

  float hit_weight(float light_pdf_w) const {
    return last_pdf_w_ == 0 ? 1 : mis_weight(last_pdf_w_ * passing_prob_, light_pdf_w);
  }

  void add_environment() {
    if (depth_ == 0 && settings_.hide_emitters) return;
    for (const ChosenEnvironment& environment : scene_.environments()) {
      alpha_ = 1;
      const Spectrum Le = environment.emitter->Le(traveller_.ray().direction);
      const float light_pdf =
          last_pdf_w_ == 0 ? 0 : environment.prob * environment.emitter->pdf_direct_w(traveller_.ray().direction);
      add(Le * hit_weight(light_pdf));
    }
  }

  void add_emission(const SurfaceEmitter& emitter, float emitter_prob, const SurfacePoint& point) {
    if (depth_ == 0 && settings_.hide_emitters) return;
    const Spectrum Le = emitter.Le(point, -traveller_.ray().direction);
    if (Le.is_black()) return;
    const float light_pdf = last_pdf_w_ == 0 ? 0 : emitter_prob * emitter.pdf_direct_w(last_position_, point);
    add(Le * hit_weight(light_pdf));
  }

  void estimate_direct_at_surface(const Object& object, const SurfacePoint& point, const Vec3& wo_local) {
    estimate_direct(
        point.p,
        [&](const Vec3& wi) {
          const Vec3 wi_local = point.to_local(wi);
          if (wi_local.z * dot(wi, point.ng) <= 0) return Bsdf::Eval{};
          return object.bsdf->eval(point, wo_local, wi_local, TransportMode::kRadiance);
        },
        &object, &point);
  }

  /// Next-event estimation: one light, one point on it. `scatter(wi)` gives the value of the scattering and its
  /// density.
  template <class Scatter>
  void estimate_direct(const Vec3& from, const Scatter& scatter, const Object* object = nullptr,
                       const SurfacePoint* point = nullptr) {
    float u_light = sampler_.next_1d();
    const Vec2 u = sampler_.next_2d();
    const EmitterChoice choice = scene_.choose_emitter(u_light);
    if (!choice.emitter || !order_counts()) return;
    const auto light = choice.emitter->sample_direct(from, u);
    if (!light) return;
    const Bsdf::Eval scattered = scatter(light->wi);
    if (scattered.value.is_black()) return;

    const Spectrum towards = throughput_ * scattered.value;
    const Ray shadow = shadow_ray(*light, point ? point->leave(light->wi) : from);
    const Passage passage = traveller_.look_along(shadow, towards, object, point);
    if (passage.prob == 0) return;
    const float weight = light->delta ? 1 : mis_weight(choice.prob * light->pdf_w, scattered.pdf_w * passage.prob);
    gather(towards * passage.transmittance * light->weight * (weight / choice.prob));
  }

  /// From `origin` to just before the light.
  static Ray shadow_ray(const DirectLightSample& light, const Vec3& origin) {
    if (!std::isfinite(light.distance)) return {origin, light.wi};
    const Vec3 to_light = light.position - origin;
    const float distance = length(to_light);
    return {origin, to_light / distance, distance * kBeforeLight};
  }
  /// The end of a shadow ray is known to a few units in the last place of its length.
  static constexpr float kBeforeLight = 1 - 1e-5f;

  const Scene& scene_;
  const PathSettings& settings_;
  Sampler& sampler_;
  SampleCounters& counters_;

  Traveller traveller_;
  Spectrum throughput_{1.0f}, radiance_{0.0f};
  Spectrum by_order_[kOrderClasses] = {Spectrum(0.0f), Spectrum(0.0f), Spectrum(0.0f), Spectrum(0.0f)};
  float alpha_ = 0;
  int depth_ = 0;        ///< edges behind us
  int order_ = 0;        ///< collisions in media behind us
  float eta_scale_ = 1;  ///< squared index here / at the sensor: takes the radiance scaling out of the roulette

  Vec3 last_position_;      ///< where the current direction was chosen ...
  float last_pdf_w_ = 0;    ///< ... and its density, 1/sr; 0 where next-event estimation could not have found its way
  float passing_prob_ = 1;  ///< see Passage::prob
  /// The throughput when the current edge began, times what pass_straight would multiply it by on the same way.
  Spectrum straight_{1.0f};
};

}  // namespace

PixelSample PathTracer::sample_radiance(const Scene& scene, const SensorRay& camera, Sampler& sampler,
                                        SampleCounters& counters) const {
  if (kind_ == Kind::kSurfaces) return Walk<false>(scene, settings_, sampler, counters).run(camera);
  return Walk<true>(scene, settings_, sampler, counters).run(camera);
}

}  // namespace turbid
