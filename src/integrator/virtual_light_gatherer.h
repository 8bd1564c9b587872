#pragma once
#include "integrator/entering_lights.h"
#include "integrator/light_gatherer.h"
#include "manylight/light_sampler.h"
#include "manylight/segment_pairs.h"
#include "manylight/shading_recorder.h"
#include "manylight/volume_points.h"

namespace turbid {

/// What shading by virtual lights needs to know, the same at all places.
struct ShadingPlan {
  const Scene& scene;
  const PathSettings& path;
  LineSettings lines;
  VolumePoints volume_points;
  int light_samples = 8;   ///< virtual lights asked for at each place
  int direct_samples = 4;  ///< the same of lights
  /// Lights shade whole ways of the sensor's walk at once (ray lights); volume_points are then for lights asked for
  /// directly.
  bool rays = false;
  const RefractiveScattering* refraction = nullptr;  ///< finds some of the light; null: these lights bring all of it
  int table_samples = 4;  ///< entering lights asked for at each place or way, where there are tables
};

/// Estimates of what one virtual light brings to places, with what stands between; black where nothing comes. For point
/// lights at a place there is nothing to draw.
class LightLines {
 public:
  LightLines(const VirtualLights& lights, const ShadingPlan& plan, const Sampler& sampler)
      : lights_(lights), settings_(plan.lines), path_(plan.path), sampler_(sampler) {}

  /// `traveller` stands at the place.
  Spectrum to_place(const Scatterer& place, size_t light, Rng& rng, const Traveller& traveller) const;
  /// What a point light brings that would bring `value` if nothing stood between. `surface`: the place, if it is one.
  Spectrum through(const Scatterer& place, const SurfaceEvent* surface, const Scatterer& light, const Spectrum& value,
                   const Traveller& traveller) const;
  /// A light, and the numbers that places are drawn from for it.
  struct Request {
    size_t light;
    Vec2 u;
  };
  /// To all places of a way together, for many lights; calls take(i, value) for each. `traveller` stands at its
  /// beginning.
  template <class Take>
  void to_way(const CollisionSegment& way, std::span<const Request> requests, const Traveller& traveller,
              const Take& take) const {
    std::array<SegmentPair, kBatch> pairs;
    for (size_t begin = 0; begin < requests.size(); begin += kBatch) {
      const auto batch = requests.subspan(begin, std::min(kBatch, requests.size() - begin));
      draw_pairs(way, batch, pairs);
      for (size_t i = 0; i < batch.size(); ++i) take(begin + i, to_way(way, batch[i], pairs[i], traveller));
    }
  }
  /// Collisions behind the light's end of the line.
  int order(size_t light) const;

 private:
  static constexpr size_t kBatch = 64;
  void draw_pairs(const CollisionSegment& way, std::span<const Request> batch,
                  std::array<SegmentPair, kBatch>& pairs) const;
  /// `pair`: of ray lights.
  Spectrum to_way(const CollisionSegment& way, const Request& request, const SegmentPair& pair,
                  const Traveller& traveller) const;
  Spectrum shadowed(const Scatterer& place, const Scatterer& light, const Traveller& traveller) const;

  const VirtualLights& lights_;
  const LineSettings& settings_;
  const PathSettings& path_;
  const Sampler& sampler_;
};

/// Recorder of walks from the sensor that virtual lights shade (see ShadingRecorder). At each place that it shades it
/// asks for lights by next-event estimation, and for virtual lights; lights that it meets by chance share with the
/// former as in `volpath`.
class VirtualLightGatherer : public ShadingRecorder {
 public:
  /// `chooser` null: every light is asked. `entering`: null without tables.
  VirtualLightGatherer(Kind kind, const ShadingPlan& plan, const VirtualLights& lights, const EnteringLights* entering,
                       LightSampler::Chooser* chooser, Sampler& sampler, SampleCounters& counters)
      : ShadingRecorder(kind),
        plan_(plan),
        lights_(lights),
        entering_(entering),
        lines_(lights, plan, sampler),
        chooser_(chooser),
        sampler_(sampler),
        counters_(counters) {}

  void begin() {
    ShadingRecorder::begin();
    direct_.emplace(plan_.scene, plan_.path, ConnectionSettings{}, plan_.refraction, sampler_, counters_);
    for (Spectrum& light : by_order_) light = Spectrum(0.0f);
  }
  /// What was found since, by class of order (kOrderClasses).
  Spectrum found(int order) const { return by_order_[order] + direct_->result().by_order[order]; }

  void before_flight(const Medium& medium, const PathState& state, const Traveller& traveller) {
    // Light that RefractiveScattering scatters where the walk would shade. Before the other walk's first x there is
    // none, as this one finds it on the same flights; behind it orders are higher.
    if (!scatters() && !expects_y()) direct_->before_flight(medium, state, traveller);
  }
  void on_passage(const Ray& way, const Medium& medium, const PathState& state, const Traveller& traveller);
  void passed_medium(const Spectrum& proxy) { direct_->passed_medium(proxy); }
  void passed_surface(const Spectrum& through) { direct_->passed_surface(through); }
  void at_collision(const CollisionEvent& event, const PathState& state, const Traveller& traveller) {
    if (shades()) shade(event, state, traveller);
  }
  void left_collision(const CollisionEvent& event, float mu, const Vec3& chosen, const PathState& state,
                      const Traveller& traveller) {
    direct_->left_collision(event, mu, chosen, state, traveller);
    ShadingRecorder::left_collision(event, mu, chosen, state, traveller);
  }
  void at_surface(const SurfaceEvent& event, const PathState& state, const Traveller& traveller) {
    if (!shades() || !(event.object.bsdf->flags() & lobe::kSmooth)) return;
    ask_lights(state, [&](const PathState& part) { direct_->at_surface(event, part, traveller); });
    ask_virtual_lights(Vertex(event, state, traveller.medium()), traveller);
  }
  void left_surface(const SurfaceEvent& event, const BsdfSample& sample, const Vec3& chosen, const PathState& state,
                    const Traveller& traveller) {
    direct_->left_surface(event, sample, chosen, state, traveller);
    ShadingRecorder::left_surface(event, sample, chosen, state, traveller);
  }
  void at_light(const Hit& hit, const Object& object, const SurfacePoint& point, const PathState& state,
                const Traveller& traveller) {
    if (!leaves_to_other()) direct_->at_light(hit, object, point, state, traveller);
  }
  void at_escape(const PathState& state, const Traveller& traveller) {
    if (!leaves_to_other()) direct_->at_escape(state, traveller);
  }

 private:
  void shade(const CollisionEvent& event, const PathState& state, const Traveller& traveller) {
    ask_lights(event, state, traveller);
    ask_virtual_lights(Vertex(event, state), traveller);
    if (!entering_) return;
    Rng rng = sampler_.aside(Purpose::kTableAtCollision, event.position, event.direction);
    const LightByOrder found = entering_->at_collision(event, state, plan_.table_samples, rng);
    for (int order = 0; order < kOrderClasses; ++order) add(order, found.light[order]);
  }
  void ask_lights(const CollisionEvent& event, const PathState& state, const Traveller& traveller) {
    ask_lights(state, [&](const PathState& part) { direct_->at_collision(event, part, traveller); });
  }
  /// Next-event estimation several times, each for a part of the path's throughput.
  template <class Ask>
  void ask_lights(const PathState& state, const Ask& ask) {
    const PathState part{state.throughput / static_cast<float>(plan_.direct_samples), state.depth, state.order,
                         state.visit_order};
    for (int i = 0; i < plan_.direct_samples; ++i) ask(part);
  }
  void ask_virtual_lights(const Vertex& vertex, const Traveller& traveller);
  /// Casts the lines of waiting_ from the place.
  void cast_lines(const Scatterer& place, const Traveller& traveller);
  void ask_along(const CollisionSegment& way, const Traveller& traveller);
  /// Calls ask(light, factor, rng) for all lights, or for those that the chooser draws. The numbers of each are its
  /// own, so that it changes nothing else whether it counts. `once`: what a point light brings has nothing random, so
  /// that one which was drawn more often is asked once.
  template <class Ask>
  void choose_lights(int order, bool once, Rng rng, const Ask& ask);
  void add(int order, const Spectrum& value) { by_order_[std::min(order, kOrderClasses - 1)] += value; }

  const ShadingPlan& plan_;
  const VirtualLights& lights_;
  const EnteringLights* entering_;
  LightLines lines_;
  LightSampler::Chooser* chooser_;
  Sampler& sampler_;
  SampleCounters& counters_;
  std::optional<LightGatherer> direct_;
  std::vector<LightLines::Request> requests_;
  std::vector<float> factors_;
  std::vector<LightSampler::Chooser::Draw> draws_;
  struct Line {
    const Scatterer* light;
    Spectrum value;  ///< if nothing stands between
  };
  std::vector<Line> waiting_;
  Spectrum by_order_[kOrderClasses] = {Spectrum(0.0f), Spectrum(0.0f), Spectrum(0.0f), Spectrum(0.0f)};
};

}  // namespace turbid
