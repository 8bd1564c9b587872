#include "integrator/path_tracer.h"

#include "integrator/light_gatherer.h"

namespace turbid {
namespace {

template <bool kSeesMedia>
PixelSample trace(const Scene& scene, const PathSettings& settings, const ConnectionSettings& connection,
                  const SensorRay& camera, Sampler& sampler, SampleCounters& counters) {
  LightGatherer gatherer(scene, settings, connection, sampler, counters);
  CameraWalk<LightGatherer, kSeesMedia> walk(scene, settings, sampler, counters, gatherer);
  const float alpha = walk.run(camera);
  PixelSample sample = gatherer.result();
  sample.alpha = alpha;
  return sample;
}

using Kind = PathTracer::Kind;

IntegratorSetup make_surfaces(const Properties& properties) {
  return {std::make_shared<PathTracer>(Kind::kSurfaces, path_settings(properties)), false};
}

}  // namespace

PixelSample PathTracer::sample_radiance(const Scene& scene, const SensorRay& camera, Sampler& sampler,
                                        SampleCounters& counters) const {
  return kind_ == Kind::kVolumes ? trace<true>(scene, settings_, connection_, camera, sampler, counters)
                                 : trace<false>(scene, settings_, connection_, camera, sampler, counters);
}

IntegratorPlugin path_row() {
  return {"path", {}, "path tracing on surfaces; media are ignored", with_common_parameters({}), make_surfaces};
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
          make_surfaces};
}

IntegratorPlugin volpath_row() {
  return {"volpath",
          {"volpathmis"},
          "path tracing with media: next-event estimation through null boundaries, all channels weighed together",
          with_common_parameters(connection_parameters("nee", "light")),
          [](const Properties& properties) {
            return IntegratorSetup{std::make_shared<PathTracer>(Kind::kVolumes, path_settings(properties),
                                                                connection_settings(properties, "nee")),
                                   false};
          }};
}

}  // namespace turbid
