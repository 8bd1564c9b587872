#pragma once
#include "integrator/bdpt_subpaths.h"
#include "integrator/camera_sample.h"

namespace turbid {

/// Makes both walks of a pixel's sample: that from a light, where lines are tried at all, then that from the sensor,
/// whose recorder is a SensorSubpath or what derives from it.
template <class SensorRecorder>
class BidirectionalWorker final : public SplattingIntegrator::Worker {
 public:
  struct Shared {
    const Scene& scene;
    const LightSources& sources;
    const PathSettings& settings;
    const StrategyWeights& weights;
    float connections;
    const RefractiveScattering* refraction;  ///< BdptContext::refraction
  };

  /// `more`: what the recorder takes beside what SensorSubpath does.
  template <class... More>
  BidirectionalWorker(const Shared& shared, uint64_t seed, SampleCounters& counters, More&&... more)
      : scene_(shared.scene),
        seed_(seed),
        light_sampler_(scene_.sampler(), hash_counters(seed, kLightStream)),
        sensor_sampler_(scene_.sampler(), seed),
        connector_(scene_, static_cast<double>(pixel_count(scene_.film())), light_sampler_, counters),
        context_{scene_,     shared.sources,    shared.settings, shared.weights, shared.connections,
                 connector_, shared.refraction, counters},
        light_(context_),
        sensor_(context_, sensor_sampler_, light_.vertices(), std::forward<More>(more)...),
        light_walk_(scene_, shared.settings, light_sampler_, counters, light_),
        sensor_walk_(scene_, shared.settings, sensor_sampler_, counters, sensor_) {}

  float run(size_t pixel, uint64_t index, ContributionSink& sink) override {
    if (context_.weights.joins()) {
      light_sampler_.start(pixel, index);
      light_.begin(sink);
      light_walk_.run(context_.sources);
    }
    const auto width = static_cast<size_t>(connector_.size().x);
    const Vec2i in_crop(static_cast<int>(pixel % width), static_cast<int>(pixel / width));
    const SensorRay camera = start_camera_sample(scene_, in_crop + scene_.film().crop_offset, index, sensor_sampler_);
    sensor_.begin(camera, hash_counters(seed_, kSelectionStream, pixel, index), sink);
    ++context_.counters.camera_samples;
    return sensor_walk_.run(camera);
  }

 private:
  /// Keeps the random choice of connections apart from the other streams.
  static constexpr uint64_t kSelectionStream = 0x6a6f696eull;

  const Scene& scene_;
  uint64_t seed_;
  Sampler light_sampler_, sensor_sampler_;
  SensorConnector connector_;
  BdptContext context_;
  LightSubpath light_;
  SensorRecorder sensor_;
  LightWalk<LightSubpath> light_walk_;
  CameraWalk<SensorRecorder> sensor_walk_;
};

}  // namespace turbid
