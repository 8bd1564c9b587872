#include "integrator/cache_placer.h"

#include <bit>

#include "integrator/camera_sample.h"

namespace turbid {

namespace {

/// The weight below which all together make up `share` of the sum, to within an eighth of an octave.
float weight_below_which(float share, std::span<const float> weights) {
  // Sums by the leading bits of the weights: numbers above 0 are in the order of their bits.
  constexpr int kShift = 20;
  std::array<double, 1 << (31 - kShift)> sums{};
  double sum = 0;
  for (const float weight : weights) {
    if (!(weight > 0) || !std::isfinite(weight)) continue;
    sums[std::bit_cast<uint32_t>(weight) >> kShift] += static_cast<double>(weight);
    sum += static_cast<double>(weight);
  }
  double left = sum * static_cast<double>(share);
  uint32_t bits = 0;
  while (bits + 1 < sums.size() && sums[bits] <= left) left -= sums[bits++];
  return std::bit_cast<float>(bits << kShift);
}

}  // namespace

/// Stops at the first place of the kind that is asked for.
class CachePlacer::Recorder : public ShadingRecorder {
 public:
  Recorder(const CachePlacer& owner, PlaceKind kind, std::span<float> weights, Sampler& sampler,
           SampleCounters& counters)
      : ShadingRecorder(Kind::kPasses),
        owner_(owner),
        lines_(owner.lights_, owner.plan_, sampler),
        kind_(kind),
        weights_(weights),
        sampler_(sampler),
        counters_(counters) {}

  const ImportanceCache::Record& result() const { return result_; }

  void on_passage(const Ray& way, const Medium& medium, const PathState& state, const Traveller& traveller) {
    if (result_.valid || !(way.t_max > 0) || !std::isfinite(way.t_max)) return;
    if (kind_ == PlaceKind::kCollision) {
      const VolumePoints one{1, owner_.plan_.volume_points.by_transmittance};
      make_collisions(way, medium, state, owner_.plan_.path.max_depth, one, sampler_,
                      [&](const CollisionEvent& event, const PathState& at) { record(Vertex(event, at), traveller); });
    } else if (kind_ == PlaceKind::kWay) {
      Rng rng = sampler_.aside(Purpose::kCachedWay, way.origin, way.direction);
      std::vector<LightLines::Request> all(weights_.size());
      for (size_t light = 0; light < all.size(); ++light) {
        const float u = rng.next_float();
        all[light] = {light, {u, rng.next_float()}};
      }
      lines_.to_way(CollisionSegment::of_sensor(way, medium, state), all, traveller,
                    [&](size_t light, const Spectrum& value) { weights_[light] = value.mean(); });
      finish({way.origin, way.direction, true});
    }
  }
  void at_surface(const SurfaceEvent& event, const PathState& state, const Traveller& traveller) {
    if (kind_ == PlaceKind::kSurface && !result_.valid && shades() && event.object.bsdf->flags() & lobe::kSmooth)
      record(Vertex(event, state, traveller.medium()), traveller);
  }
  bool goes_on() const { return !result_.valid && ShadingRecorder::goes_on(); }

 private:
  void record(const Vertex& vertex, const Traveller& traveller) {
    const Scatterer place(vertex, TransportMode::kRadiance);
    Rng rng = sampler_.aside(Purpose::kCachedPlace, vertex.position, vertex.given);
    const size_t points = owner_.lights_.points().size();
    for (size_t light = 0; light < points; ++light)
      weights_[light] = unshadowed(place, owner_.lights_.points()[light], owner_.plan_.lines).mean();
    // Whether there is a shadow is asked only of lights that matter; the weak ones are chosen as if half were visible.
    constexpr float kWeakShare = 0.1f, kHalf = 0.5f;
    const float least = weight_below_which(kWeakShare, weights_.first(points));
    for (size_t light = 0; light < weights_.size(); ++light) {
      if (light < points && weights_[light] < least)
        weights_[light] *= kHalf;
      else if (light >= points || weights_[light] > 0)
        weights_[light] = lines_.to_place(place, light, rng, traveller).mean();
    }
    finish({vertex.position, vertex.is_surface() ? place.normal() : Vec3(0), true});
  }
  void finish(const ImportanceCache::Record& where) {
    counters_.connections += weights_.size();
    result_ = where;
  }

  const CachePlacer& owner_;
  LightLines lines_;
  PlaceKind kind_;
  std::span<float> weights_;
  Sampler& sampler_;
  SampleCounters& counters_;
  ImportanceCache::Record result_;
};

ImportanceCache::Record CachePlacer::record(PlaceKind kind, size_t number, std::span<float> weights,
                                            SampleCounters& counters) const {
  constexpr uint64_t kMostTries = 16;  // walks that find no such place
  const Scene& scene = plan_.scene;
  const Vec2i size = scene.film().image_size();
  Sampler sampler(SamplerKind::kIndependent, seed_);
  Rng pixels(hash_counters(seed_, number));
  for (uint64_t attempt = 0; attempt < kMostTries; ++attempt) {
    const Vec2i pixel(static_cast<int>(pixels.next_float() * static_cast<float>(size.x)),
                      static_cast<int>(pixels.next_float() * static_cast<float>(size.y)));
    const SensorRay camera =
        start_camera_sample(scene, pixel + scene.film().crop_offset, number * kMostTries + attempt, sampler);
    Recorder recorder(*this, kind, weights, sampler, counters);
    CameraWalk<Recorder> walk(scene, plan_.path, sampler, counters, recorder);
    walk.run(camera);
    if (recorder.result().valid) return recorder.result();
  }
  return {};
}

}  // namespace turbid
