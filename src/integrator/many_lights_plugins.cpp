#include "integrator/many_lights.h"

// What scene files say of `vpl` and `vrl`.
namespace turbid {

namespace {

const std::vector<std::pair<std::string, ManyLightsSettings::Sampler>> kSamplers = {
    {"importance_cache", ManyLightsSettings::Sampler::kImportanceCache},
    {"light_tree", ManyLightsSettings::Sampler::kLightTree},
    {"lfg", ManyLightsSettings::Sampler::kUnshadowed},
    {"power", ManyLightsSettings::Sampler::kPower},
    {"uniform", ManyLightsSettings::Sampler::kUniform},
    {"all", ManyLightsSettings::Sampler::kAll}};

Parameter sampler_parameter(bool rays) {
  if (rays)
    return word(
        "light_sampler", "importance_cache",
        "how virtual lights are chosen for surfaces and for whole ways through media: importance_cache (by what "
        "they bring to such nearby), uniform; all takes every one",
        {"importance_cache", "uniform", "all"});
  std::vector<std::string> samplers;
  for (const auto& entry : kSamplers) samplers.push_back(entry.first);
  return word("light_sampler", "importance_cache",
              "how virtual lights are chosen: importance_cache (by what they bring to places nearby), light_tree, lfg "
              "(each place asks all lights, but not for shadows), power, uniform; all takes every one",
              samplers);
}

std::vector<Parameter> parameters(bool rays) {
  std::vector<Parameter> own = {
      sampler_parameter(rays),
      {"lights", ParameterType::kInteger, "1000", "about so many virtual lights in a set", kAtLeastOne},
      {"reuse", ParameterType::kInteger, "16", "samples per pixel that share a set; then new lights are made",
       kAtLeastOne},
      {"light_samples", ParameterType::kInteger, "8", "virtual lights asked for at each place that is shaded",
       kAtLeastOne},
      {"direct_samples", ParameterType::kInteger, "4", "lights asked for at each place that is shaded", kAtLeastOne},
      {"volume_points", ParameterType::kInteger, "4",
       rays ? "places on each way through a medium where lights are asked for directly"
            : "places that are shaded on each way through a medium",
       kAtLeastOne},
      word("volume_sampling", "transmittance",
           "where on the way: by transmittance, or evenly (uniform); media that vary: evenly",
           {"transmittance", "uniform"}),
      {"surface_caches", ParameterType::kInteger, "1000", "cache points on surfaces", kNonNegative},
      {"volume_caches", ParameterType::kInteger, "1000",
       rays ? "cache points that are ways through media" : "cache points in media", kNonNegative},
      {"nearest",
       ParameterType::kInteger,
       "3",
       "cache points that are mixed at a place",
       {.min = 1, .max = ImportanceCache::kMostNearest}},
      word("cache_mixture", "wide",
           "what is mixed with the nearest cache points: wide (points around them, all points, near lights, a little "
           "uniform choice), seed (uniform choice alone, as in the seed)",
           {"wide", "seed"}),
      {"memory", ParameterType::kInteger, "512", "most memory for cache points, MiB", kAtLeastOne},
      {"clamp_distance", ParameterType::kFloat, "0",
       "virtual lights nearer than this count as at this distance: less noise, and darker; 0: as they are",
       kNonNegative},
      {"least_distance", ParameterType::kFloat, "0",
       "virtual lights nearer than this are left out, for comparisons; 0: all count", kNonNegative},
      single_scattering_parameter()};
  if (rays)
    for (Parameter& parameter : entering_parameters()) own.push_back(std::move(parameter));
  return with_common_parameters(std::move(own));
}

ManyLightsSettings settings_of(const Properties& properties, bool rays) {
  const auto count = [&](const std::string& name) {
    return static_cast<int>(std::min<int64_t>(properties.integer(name), int64_t{1} << 30));
  };
  ManyLightsSettings own;
  own.rays = rays;
  const std::string sampler = properties.string("light_sampler");
  own.sampler =
      std::find_if(kSamplers.begin(), kSamplers.end(), [&](const auto& e) { return e.first == sampler; })->second;
  own.lights = static_cast<size_t>(count("lights"));
  own.reuse = count("reuse");
  own.light_samples = count("light_samples");
  own.direct_samples = count("direct_samples");
  own.volume_points = {count("volume_points"), properties.string("volume_sampling") == "transmittance"};
  const auto nearest = static_cast<size_t>(count("nearest"));
  own.caches = {
      .points = {static_cast<size_t>(count("surface_caches")), static_cast<size_t>(count("volume_caches")), 0},
      .nearest = nearest,
      .shares = properties.string("cache_mixture") == "seed" ? CacheShares::seed(nearest) : CacheShares{},
      .memory = static_cast<size_t>(count("memory")) << 20};
  own.lines.clamp_distance = properties.number("clamp_distance");
  own.lines.least_distance = properties.number("least_distance");
  own.refraction = refraction_settings(properties);
  if (!rays) return own;
  own.table = table_settings(properties, path_settings(properties));
  own.table.from_order = own.table.table_order();  // two collisions are what ray lights find anyway
  own.entering = entering_settings(properties);
  return own;
}

IntegratorPlugin make_row(const std::string& name, const std::string& meaning, bool rays) {
  return {name, {}, meaning, parameters(rays), [rays](const Properties& properties) {
            return IntegratorSetup{
                std::make_shared<ManyLights>(path_settings(properties), settings_of(properties, rays)), false};
          }};
}

}  // namespace

IntegratorPlugin vpl_row() {
  return make_row(
      "vpl", "virtual point lights on surfaces and in media, chosen by importance caching or in simpler ways", false);
}

IntegratorPlugin vrl_row() {
  return make_row(
      "vrl",
      "virtual ray lights: what light flies through media shades the ways of the sensor's walk as wholes; on "
      "surfaces virtual point lights",
      true);
}

}  // namespace turbid
