#include "integrator/bdpt.h"

#include "integrator/bdpt_subpaths.h"
#include "integrator/camera_sample.h"

namespace turbid {
namespace {

/// Keeps the random choice of connections apart from the other streams.
constexpr uint64_t kSelectionStream = 0x6a6f696eull;

class Tracer final : public SplattingIntegrator::Worker {
 public:
  Tracer(const Scene& scene, const LightSources& sources, const PathSettings& settings, const StrategyWeights& weights,
         float connections, uint64_t seed, SampleCounters& counters)
      : scene_(scene),
        seed_(seed),
        light_sampler_(scene.sampler(), hash_counters(seed, kLightStream)),
        sensor_sampler_(scene.sampler(), seed),
        connector_(scene, static_cast<double>(pixel_count(scene.film())), light_sampler_, counters),
        context_{scene, sources, settings, weights, connections, connector_, counters},
        light_(context_),
        sensor_(context_, sensor_sampler_, light_.vertices()),
        light_walk_(scene, settings, light_sampler_, counters, light_),
        sensor_walk_(scene, settings, sensor_sampler_, counters, sensor_) {}

  float run(size_t pixel, uint64_t index, ContributionSink& sink) override {
    light_sampler_.start(pixel, index);
    light_.begin(sink);
    light_walk_.run(context_.sources);

    const auto width = static_cast<size_t>(connector_.size().x);
    const Vec2i in_crop(static_cast<int>(pixel % width), static_cast<int>(pixel / width));
    const SensorRay camera = start_camera_sample(scene_, in_crop + scene_.film().crop_offset, index, sensor_sampler_);
    sensor_.begin(camera, hash_counters(seed_, kSelectionStream, pixel, index), sink);
    ++context_.counters.camera_samples;
    return sensor_walk_.run(camera);
  }

 private:
  const Scene& scene_;
  uint64_t seed_;
  Sampler light_sampler_, sensor_sampler_;
  SensorConnector connector_;
  BdptContext context_;
  LightSubpath light_;
  SensorSubpath sensor_;
  LightWalk<LightSubpath> light_walk_;
  CameraWalk<SensorSubpath> sensor_walk_;
};

}  // namespace

std::unique_ptr<SplattingIntegrator::Worker> BidirectionalPathTracer::make_worker(const Scene& scene, uint64_t seed,
                                                                                  SampleCounters& counters) const {
  return std::make_unique<Tracer>(scene, *sources_, settings_, weights_, own_.connections, seed, counters);
}

IntegratorPlugin bdpt_row() {
  return {"bdpt",
          {},
          "bidirectional path tracing: paths from lights and from the sensor, joined in all ways and weighed against "
          "each other",
          with_common_parameters(
              {{"heuristic", ParameterType::kString, "power", "how the ways to make a path share it: power or balance"},
               {"connections",
                ParameterType::kFloat,
                "8",
                "about how many of the joining lines are tried for paths of one length",
                {.min = 1}},
               {"visualize_strategies", ParameterType::kBoolean, "false",
                "writes what each way contributes as layers strategy.weighted.K.S and strategy.plain.K.S: K edges, S "
                "vertices from the light"},
               {"visualize_depth",
                ParameterType::kInteger,
                "6",
                "most edges of the paths in these layers",
                {.min = 1, .max = 16}}}),
          [](const Properties& properties) {
            BdptSettings own;
            const std::string heuristic = properties.string("heuristic");
            if (heuristic != "power" && heuristic != "balance")
              properties.refuse("heuristic", "must be 'power' or 'balance', found '" + heuristic + "'");
            if (heuristic == "balance") own.heuristic = StrategyWeights::Heuristic::kBalance;
            own.connections = properties.number("connections");
            if (properties.boolean("visualize_strategies"))
              own.shown_edges = static_cast<int>(properties.integer("visualize_depth"));
            return IntegratorSetup{std::make_shared<BidirectionalPathTracer>(path_settings(properties), own), false};
          }};
}

}  // namespace turbid
