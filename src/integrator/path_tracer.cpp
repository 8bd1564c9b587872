#include "integrator/path_tracer.h"

#include "integrator/refractive_gatherer.h"
#include "path/walk.h"

namespace turbid {
namespace {

/// Power heuristic with exponent 2 (Veach 1997, sect. 9.2.3) for one sample of each of two techniques.
float mis_weight(float pdf, float other_pdf) {
  if (pdf == 0) return 0;
  const float ratio = other_pdf / pdf;
  return 1 / (1 + ratio * ratio);
}

/// Gathers the light that a walk from the sensor finds: by chance, and by asking at every vertex.
class LightGatherer : public WalkRecorder {
 public:
  /// `refraction` may be null.
  LightGatherer(const Scene& scene, const PathSettings& settings, Sampler& sampler, SampleCounters& counters,
                const RefractiveScattering* refraction)
      : scene_(scene), settings_(settings), sampler_(sampler) {
    if (refraction) refraction_.emplace(*refraction, scene, settings, sampler, counters);
  }

  const PixelSample& result() const { return result_; }

  void before_flight(const Medium& medium, const PathState& state, const Traveller& traveller) {
    if (refraction_) add(1, refraction_->before_flight(medium, state, traveller));
  }
  void on_segment(const Ray&, const Medium& medium, const PathState& state, const Traveller::Leg& leg) {
    if (medium.emits() && (state.depth > 0 || !settings_.hide_emitters)) gather(state, leg.emission);
  }
  void passed_medium(const Spectrum& proxy) {
    const Spectrum passed = straight_ * proxy;
    if (!straight_.is_black()) passing_prob_ *= passed.sum() / straight_.sum();
    straight_ = passed;
  }
  void passed_surface(const Spectrum& through) {
    passing_prob_ *= null_prob(through);
    straight_ *= through;
  }

  void at_collision(const CollisionEvent& event, const PathState& state, const Traveller& traveller) {
    if (traveller.blind()) return;
    estimate_direct(event.position, state, traveller, [&](const Vec3& wi) {
      const float f = event.medium.phase().eval(dot(event.direction, wi));
      return Bsdf::Eval{Spectrum(f), f};
    });
  }
  void left_collision(const CollisionEvent& event, float mu, const Vec3&, const PathState& state,
                      const Traveller& traveller) {
    if (refraction_) refraction_->left_collision(event, state);
    set_out(event.position, traveller.blind() ? 0 : event.medium.phase().eval(mu), state.throughput);
  }

  void at_surface(const SurfaceEvent& event, const PathState& state, const Traveller& traveller) {
    if (!(event.object.bsdf->flags() & lobe::kSmooth)) return;
    const SurfacePoint& point = event.point;
    estimate_direct(
        point.p, state, traveller,
        [&](const Vec3& wi) {
          const Vec3 wi_local = point.to_local(wi);
          if (wi_local.z * dot(wi, point.ng) <= 0) return Bsdf::Eval{};
          return event.object.bsdf->eval(point, event.given_local, wi_local, TransportMode::kRadiance);
        },
        &event);
  }
  void left_surface(const SurfaceEvent& event, const BsdfSample& sample, const Vec3& chosen, const PathState& state,
                    const Traveller& traveller) {
    if (refraction_) refraction_->left_surface(event, sample, traveller);
    set_out(event.point.leave(chosen), sample.pdf_w, state.throughput);
  }

  void at_light(const Hit& hit, const Object& object, const SurfacePoint& point, const PathState& state,
                const Traveller& traveller) {
    if ((state.depth == 1 && settings_.hide_emitters) || counted_elsewhere(false)) return;
    const SurfaceEmitter& emitter = *object.emitter;
    const Spectrum Le = emitter.Le(point, -traveller.ray().direction);
    if (Le.is_black()) return;
    gather(state, Le * hit_weight([&] {
                    return scene_.choice_prob(scene_.emitter_index(hit)) *
                           emitter.pdf_direct_w(last_position_, point.p, point.ng);
                  }));
  }
  void at_escape(const PathState& state, const Traveller& traveller) {
    if ((state.depth == 1 && settings_.hide_emitters) || counted_elsewhere(true)) return;
    const Vec3& direction = traveller.ray().direction;
    for (const ChosenEnvironment& environment : scene_.environments()) {
      gather(state, environment.emitter->Le(direction) *
                        hit_weight([&] { return environment.prob * environment.emitter->pdf_direct_w(direction); }));
    }
  }

 private:
  /// Begins a new edge whose direction was chosen with density pdf_w; 0: no other technique can choose it.
  void set_out(const Vec3& position, float pdf_w, const Spectrum& throughput) {
    last_position_ = position;
    last_pdf_w_ = pdf_w;
    passing_prob_ = 1;
    straight_ = throughput;
  }

  bool counted_elsewhere(bool environment) const { return refraction_ && refraction_->has_counted(environment); }

  /// Of light met by chance; `light_pdf_w`: density of next-event estimation, 1/sr where the direction was chosen.
  template <class Pdf>
  float hit_weight(const Pdf& light_pdf_w) const {
    return last_pdf_w_ == 0 ? 1 : mis_weight(last_pdf_w_ * passing_prob_, light_pdf_w());
  }

  void gather(const PathState& state, const Spectrum& value) {
    if (settings_.order_counts(state.order)) add(state.order, state.throughput * value);
  }

  void add(int order, const Spectrum& light) {
    result_.radiance += light;
    result_.by_order[std::min(order, kOrderClasses - 1)] += light;
  }

  /// Next-event estimation: one light, one point on it. `scatter(wi)` gives the value of the scattering and its
  /// density.
  template <class Scatter>
  void estimate_direct(const Vec3& from, const PathState& state, const Traveller& traveller, const Scatter& scatter,
                       const SurfaceEvent* surface = nullptr) {
    float u_light = sampler_.next_1d();
    const Vec2 u = sampler_.next_2d();
    const EmitterChoice choice = scene_.choose_emitter(u_light);
    if (!choice.emitter || !settings_.order_counts(state.order)) return;
    const auto light = choice.emitter->sample_direct(from, u);
    if (!light) return;
    const Bsdf::Eval scattered = scatter(light->wi);
    if (scattered.value.is_black()) return;

    const Spectrum towards = state.throughput * scattered.value;
    const Ray shadow = ray_to_light(*light, surface ? surface->point.leave(light->wi) : from);
    const Passage passage = traveller.look_along(shadow, towards, surface);
    if (passage.prob == 0) return;
    const float weight = light->delta ? 1 : mis_weight(choice.prob * light->pdf_w, scattered.pdf_w * passage.prob);
    add(state.order, towards * passage.transmittance * light->weight * (weight / choice.prob));
  }

  const Scene& scene_;
  const PathSettings& settings_;
  Sampler& sampler_;

  std::optional<RefractiveGatherer> refraction_;  ///< empty: paths find everything
  PixelSample result_{Spectrum(0.0f), 0};
  Vec3 last_position_;      ///< where the current direction was chosen ...
  float last_pdf_w_ = 0;    ///< ... and its density, 1/sr; 0 where next-event estimation could not have found its way
  float passing_prob_ = 1;  ///< see Passage::prob
  /// The throughput when the current edge began, times what pass_straight would multiply it by on the same way.
  Spectrum straight_{1.0f};
};

template <bool kSeesMedia>
PixelSample trace(const Scene& scene, const PathSettings& settings, const RefractiveScattering* refraction,
                  const SensorRay& camera, Sampler& sampler, SampleCounters& counters) {
  LightGatherer gatherer(scene, settings, sampler, counters, refraction);
  CameraWalk<LightGatherer, kSeesMedia> walk(scene, settings, sampler, counters, gatherer);
  const float alpha = walk.run(camera);
  PixelSample sample = gatherer.result();
  sample.alpha = alpha;
  return sample;
}

using Kind = PathTracer::Kind;

template <Kind kKind>
IntegratorSetup make(const Properties& properties) {
  return {std::make_shared<PathTracer>(kKind, path_settings(properties)), false};
}

}  // namespace

PixelSample PathTracer::sample_radiance(const Scene& scene, const SensorRay& camera, Sampler& sampler,
                                        SampleCounters& counters) const {
  return kind_ == Kind::kVolumes ? trace<true>(scene, settings_, scattering_.get(), camera, sampler, counters)
                                 : trace<false>(scene, settings_, nullptr, camera, sampler, counters);
}

void PathTracer::prepare(const Scene& scene, uint64_t, const StopFlag&) {
  if (refraction_) scattering_ = std::make_unique<const RefractiveScattering>(scene, *refraction_);
}

IntegratorPlugin path_row() {
  return {"path", {}, "path tracing on surfaces; media are ignored", with_common_parameters({}), make<Kind::kSurfaces>};
}

IntegratorPlugin direct_row() {
  const std::string ignored = "accepted for Mitsuba's sake, without effect";
  return {"direct",
          {},
          "light that reaches the sensor after at most one scattering: path with max_depth = 2",
          with_common_parameters({{"shading_samples", ParameterType::kInteger, "1", ignored},
                                  {"emitter_samples", ParameterType::kInteger, "1", ignored},
                                  {"bsdf_samples", ParameterType::kInteger, "1", ignored}},
                                 "2"),
          make<Kind::kSurfaces>};
}

IntegratorPlugin volpath_row() {
  return {"volpath",
          {"volpathmis"},
          "path tracing with media: next-event estimation through null boundaries, all channels weighed together",
          with_common_parameters(
              {{.name = "single_scattering",
                .type = ParameterType::kString,
                .default_text = "path",
                .meaning = "light that one smooth boundary of triangles bends before it scatters once: found by paths, "
                           "or as singlescatter finds it",
                .choices = {"path", "refractive"}}}),
          [](const Properties& properties) {
            const bool refractive = properties.string("single_scattering") == "refractive";
            return IntegratorSetup{std::make_shared<PathTracer>(
                                       Kind::kVolumes, path_settings(properties),
                                       refractive ? std::optional<RefractiveSettings>(std::in_place) : std::nullopt),
                                   false};
          }};
}

IntegratorPlugin single_scatter_row() {
  return {
      "singlescatter",
      {},
      "volpath, with single scattering through smooth boundaries of triangles followed from the light: volume "
      "caustics of lights of any size",
      with_common_parameters(
          {{.name = "method",
            .type = ParameterType::kString,
            .default_text = "triangle_intervals",
            .meaning =
                "triangle_intervals (where each triangle's light meets the sensor's path), point_sampling (points of "
                "it), straight_line (as if nothing bent light: wrong), none (left out, to see what it adds)",
            .choices = {"triangle_intervals", "point_sampling", "straight_line", "none"}},
           {"samples", ParameterType::kInteger, "1", "per triangle's interval, or points per segment of a path",
            kAtLeastOne},
           {"environments", ParameterType::kBoolean, "false",
            "follow the light of the sky, too, and do not leave it to paths, which meet it easily"},
           {"midpoint", ParameterType::kBoolean, "false",
            "samples in the middle of their strata, as published, not anywhere in them"},
           {"focusing", ParameterType::kBoolean, "true",
            "false: light falls with the square of the distance, however the boundary focuses it (wrong)"}}),
      [](const Properties& properties) {
        RefractiveSettings refraction;
        const std::string method = properties.string("method");
        if (method == "point_sampling") refraction.method = RefractiveMethod::kPointSampling;
        if (method == "straight_line") refraction.method = RefractiveMethod::kStraightLine;
        if (method == "none") refraction.method = RefractiveMethod::kNone;
        refraction.samples = static_cast<int>(properties.integer("samples"));
        refraction.environments = properties.boolean("environments");
        refraction.in_middle = properties.boolean("midpoint");
        refraction.focusing = properties.boolean("focusing");
        return IntegratorSetup{std::make_shared<PathTracer>(Kind::kVolumes, path_settings(properties), refraction),
                               false};
      }};
}

}  // namespace turbid
