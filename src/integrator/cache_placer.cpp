#include "integrator/cache_placer.h"

#include "integrator/camera_sample.h"

namespace turbid {

/// Stops at the first place of the kind that is asked for.
class CachePlacer::Recorder : public ShadingRecorder {
 public:
  Recorder(const CachePlacer& owner, bool surface, std::span<float> weights, Sampler& sampler, SampleCounters& counters)
      : ShadingRecorder(Kind::kPasses),
        owner_(owner),
        surface_(surface),
        weights_(weights),
        sampler_(sampler),
        counters_(counters) {}

  const ImportanceCache::Record& result() const { return result_; }

  void on_passage(const Ray& way, const Medium& medium, const PathState& state, const Traveller& traveller) {
    if (surface_ || result_.valid) return;
    const VolumePoints one{1, owner_.plan_.volume_points.by_transmittance};
    make_collisions(way, medium, state, owner_.plan_.path.max_depth, one, sampler_,
                    [&](const CollisionEvent& event, const PathState& at) { record(Vertex(event, at), traveller); });
  }
  void at_surface(const SurfaceEvent& event, const PathState& state, const Traveller& traveller) {
    if (surface_ && !result_.valid && shades() && event.object.bsdf->flags() & lobe::kSmooth)
      record(Vertex(event, state, traveller.medium()), traveller);
  }
  bool goes_on() const { return !result_.valid && ShadingRecorder::goes_on(); }

 private:
  void record(const Vertex& vertex, const Traveller& traveller) {
    const Scatterer place(vertex, TransportMode::kRadiance);
    const auto& lights = owner_.lights_.points();
    for (size_t i = 0; i < lights.size(); ++i)
      weights_[i] = shadowed(place, lights[i], owner_.plan_.lines, traveller).mean();
    counters_.connections += lights.size();
    result_ = {vertex.position, place.normal(), true};
  }

  const CachePlacer& owner_;
  bool surface_;
  std::span<float> weights_;
  Sampler& sampler_;
  SampleCounters& counters_;
  ImportanceCache::Record result_;
};

ImportanceCache::Record CachePlacer::record(bool surface, size_t number, std::span<float> weights,
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
    Recorder recorder(*this, surface, weights, sampler, counters);
    CameraWalk<Recorder> walk(scene, plan_.path, sampler, counters, recorder);
    walk.run(camera);
    if (recorder.result().valid) return recorder.result();
  }
  return {};
}

}  // namespace turbid
