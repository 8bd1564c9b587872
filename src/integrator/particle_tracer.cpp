#include "integrator/particle_tracer.h"

#include "path/walk.h"

namespace turbid {
namespace {

class Tracer final : public SplattingIntegrator::Worker {
 public:
  Tracer(const Scene& scene, const LightSources& sources, const PathSettings& settings,
         const CameraConnectionSettings& connection, uint64_t seed, SampleCounters& counters)
      : sources_(sources),
        sampler_(scene.sampler(), hash_counters(seed, kLightStream)),
        splatter_(scene, settings, connection, sampler_, counters),
        walk_(scene, settings, sampler_, counters, splatter_) {}

  float run(size_t pixel, uint64_t index, ContributionSink& sink) override {
    sampler_.start(pixel, index);
    splatter_.begin(sink);
    walk_.run(sources_);
    return 1;
  }

 private:
  const LightSources& sources_;
  Sampler sampler_;
  LightSplatter splatter_;
  LightWalk<LightSplatter> walk_;
};

/// The value of a parameter that is one of some words.
template <class Value>
Value one_of(const Properties& properties, const char* name, const std::map<std::string, Value>& words) {
  const std::string word = properties.string(name);
  const auto found = words.find(word);
  if (found != words.end()) return found->second;
  std::vector<std::string> known;
  for (const auto& entry : words) known.push_back(entry.first);
  properties.refuse(name, "has the unknown value '" + word + "'" + suggestion(word, known));
}

}  // namespace

std::unique_ptr<SplattingIntegrator::Worker> ParticleTracer::make_worker(const Scene& scene, uint64_t seed,
                                                                         SampleCounters& counters) const {
  return std::make_unique<Tracer>(scene, *sources_, settings_, connection_, seed, counters);
}

IntegratorPlugin particle_tracer_row() {
  return {
      "ptracer",
      {},
      "light tracing: paths from the lights, joined with the sensor; cannot see through mirrors and smooth glass",
      with_common_parameters(
          {{"camera_connection", ParameterType::kString, "standard",
            "how the last collision before the sensor is found: standard (by the walk), equiangular, once_more "
            "(inserted), mis (all of them)"},
           {"sampling", ParameterType::kString, "angle",
            "of inserted collisions: angle (constant weight on the whole sphere) or seed (as published, forward)"}}),
      [](const Properties& properties) {
        const CameraConnectionSettings connection{
            one_of<CameraConnection>(properties, "camera_connection",
                                     {{"standard", CameraConnection::kStandard},
                                      {"equiangular", CameraConnection::kEquiangular},
                                      {"once_more", CameraConnection::kOnceMore},
                                      {"mis", CameraConnection::kMis}}),
            one_of<Insertion>(properties, "sampling",
                              {{"angle", Insertion::kAngle}, {"seed", Insertion::kSolidAngle}})};
        return IntegratorSetup{std::make_shared<ParticleTracer>(path_settings(properties), connection), false};
      }};
}

}  // namespace turbid
