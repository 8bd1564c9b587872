#include <fmt/ranges.h>

#include "integrator/bdpt.h"
#include "integrator/refractive_gatherer.h"
#include "integrator/upbp.h"

namespace turbid {
namespace {

std::string all_names() { return fmt::format("{}", fmt::join(kTechniqueNames, ", ")); }

std::vector<Parameter> parameters(const std::string& techniques) {
  std::vector<Parameter> own = {
      {"techniques", ParameterType::kString, techniques,
       "how paths are made, in any combination (a space, comma or + between them): bpt (lines between two walks), "
       "surf "
       "(photons at surfaces), pp3d, pb2d (photon points near collisions, near flights), bp2d, bb1d (photon beams); "
       "auto: a pilot chooses"},
      heuristic_parameter("balance"),
      connections_parameter(),
      {"radius", ParameterType::kFloat, "0",
       "of kernels in media in the first image, scene units; 0: a pixel, and no more than keeps the bias at "
       "boundaries "
       "small",
       kNonNegative},
      {"surface_radius", ParameterType::kFloat, "0", "of disks on surfaces in the first image; 0: by pixels",
       kNonNegative},
      {"pixels", ParameterType::kFloat, "0.5", "radii in widths of what a pixel covers, where they are 0", kPositive},
      {"keep",
       ParameterType::kFloat,
       "0.6666667",
       "how much of each image's light the shrinking kernels keep, in (0, 1]; 1: radii stay",
       {.min = 0, .max = 1, .open_min = true}},
      word("photon_beams", "short", "end where light collides (short) or at the next surface (long)",
           {"short", "long"}),
      word("sensor_beams", "short", "end where walks from the sensor collide (short) or at the next surface (long)",
           {"short", "long"}),
      {"light_paths", ParameterType::kInteger, "1", "light paths per pixel of each image", kAtLeastOne},
      {"beam_paths", ParameterType::kInteger, "0",
       "how many of an image's light paths leave beams; 0: the pilot chooses, or 5000 where techniques are named",
       kNonNegative},
      {"memory", ParameterType::kInteger, "1024", "about the most memory for photons, MiB: fewer light paths above it",
       kAtLeastOne},
      {"visualize_techniques", ParameterType::kBoolean, "false",
       "writes what each technique contributes as layers technique.NAME"},
      single_scattering_parameter()};
  for (Parameter& parameter : entering_parameters()) own.push_back(std::move(parameter));
  return with_common_parameters(std::move(own));
}

UpbpSettings settings_of(const Properties& properties) {
  UpbpSettings own;
  const std::string text = properties.string("techniques");
  const bool chosen = text == "auto";
  for (size_t at = chosen ? text.size() : 0; (at = text.find_first_not_of(", +", at)) != std::string::npos;) {
    const size_t end = std::min(text.find_first_of(", +", at), text.size());
    const std::string name = text.substr(at, end - at);
    const auto found = std::find(kTechniqueNames.begin(), kTechniqueNames.end(), name);
    if (found == kTechniqueNames.end())
      properties.refuse("techniques", fmt::format("names '{}', expected some of {}", name, all_names()));
    own.techniques.set(static_cast<size_t>(found - kTechniqueNames.begin()));
    at = end;
  }
  if (!chosen && own.techniques.none()) properties.refuse("techniques", "must name some of " + all_names());
  own.heuristic = heuristic_of(properties);
  own.connections = properties.number("connections");
  if (properties.number("radius") > 0) own.radius = properties.number("radius");
  if (properties.number("surface_radius") > 0) own.surface_radius = properties.number("surface_radius");
  own.pixels = properties.number("pixels");
  own.keep = properties.number("keep");
  own.long_beams = properties.string("photon_beams") == "long";
  own.long_flights = properties.string("sensor_beams") == "long";
  const auto count = [&](const char* name) {
    return static_cast<int>(std::min<int64_t>(properties.integer(name), 1 << 30));
  };
  own.light_paths = count("light_paths");
  own.beam_paths = count("beam_paths");
  own.memory = static_cast<size_t>(count("memory")) << 20;
  own.shows_techniques = properties.boolean("visualize_techniques");
  own.refraction = refraction_settings(properties);
  own.table = table_settings(properties, path_settings(properties));
  own.entering = entering_settings(properties);
  return own;
}

IntegratorPlugin row(const std::string& name, const std::string& techniques, const std::string& summary) {
  return {name, {}, summary, parameters(techniques), [](const Properties& properties) {
            return IntegratorSetup{std::make_shared<Upbp>(path_settings(properties), settings_of(properties)), false};
          }};
}

}  // namespace

std::vector<IntegratorPlugin> upbp_rows() {
  return {
      row("upbp", "auto",
          "unified points, beams and paths: bidirectional paths, photon points and photon beams, weighed together"),
      row("photonmapper", "surf, pp3d", "photons at surfaces and in media (upbp with surf and pp3d)"),
      row("bre", "surf, pb2d", "photons at surfaces, photon points along flights in media (upbp with surf and pb2d)"),
      row("beams", "surf, bb1d", "photons at surfaces, photon beams in media (upbp with surf and bb1d)")};
}

}  // namespace turbid
