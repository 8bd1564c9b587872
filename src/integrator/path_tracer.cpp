#include "integrator/path_tracer.h"

#include "integrator/light_gatherer.h"

namespace turbid {
namespace {

template <bool kSeesMedia>
PixelSample trace(const Scene& scene, const PathSettings& settings, const ConnectionSettings& connection,
                  const RefractiveScattering* refraction, const SensorRay& camera, Sampler& sampler,
                  SampleCounters& counters) {
  LightGatherer gatherer(scene, settings, connection, refraction, sampler, counters);
  CameraWalk<LightGatherer, kSeesMedia> walk(scene, settings, sampler, counters, gatherer);
  const float alpha = walk.run(camera);
  PixelSample sample = gatherer.result();
  sample.alpha = alpha;
  return sample;
}

/// Looks the table up at each first collision of a visit.
class TableGatherer : public LightGatherer {
 public:
  TableGatherer(const Scene& scene, const PathSettings& settings, const TableLight& table,
                const std::vector<EnteringLight>& lights, Sampler& sampler, SampleCounters& counters)
      : LightGatherer(scene, settings, {}, nullptr, sampler, counters),
        settings_(settings),
        table_(table),
        lights_(lights),
        sampler_(sampler) {}

  void at_collision(const CollisionEvent& event, const PathState& state, const Traveller& traveller) {
    LightGatherer::at_collision(event, state, traveller);
    if (state.visit_order != 1 || lights_.empty()) return;
    const auto boundaries = table_.boundaries_around(event.position, event.direction, event.medium);
    Rng rng = sampler_.aside(event.position, event.direction);
    for (const EnteringLight& light : lights_)
      add(table_.from_order(), table_.at_collision(light, boundaries, event, state, settings_, rng));
  }

 private:
  const PathSettings& settings_;
  const TableLight& table_;
  const std::vector<EnteringLight>& lights_;
  Sampler& sampler_;
};

using Kind = PathTracer::Kind;

IntegratorSetup make_surfaces(const Properties& properties) {
  return {std::make_shared<PathTracer>(Kind::kSurfaces, path_settings(properties)), false};
}

}  // namespace

PixelSample PathTracer::sample_radiance(const Scene& scene, const SensorRay& camera, Sampler& sampler,
                                        SampleCounters& counters) const {
  if (table_) return trace_with_table(scene, camera, sampler, counters);
  return kind_ == Kind::kVolumes
             ? trace<true>(scene, settings_, connection_, scattering_.get(), camera, sampler, counters)
             : trace<false>(scene, settings_, connection_, nullptr, camera, sampler, counters);
}

/// One walk from a light for each from the sensor, and all that enters on the one for every visit of the other.
PixelSample PathTracer::trace_with_table(const Scene& scene, const SensorRay& camera, Sampler& sampler,
                                         SampleCounters& counters) const {
  Rng aside = sampler.aside(camera.ray.origin, camera.ray.direction);
  Sampler light_sampler(SamplerKind::kIndependent, hash_counters(aside.next_u32(), aside.next_u32()));
  light_sampler.start(0, 0);
  EnteringLightKeeper keeper(scene, *table_, counters);
  keeper.begin(aside);
  const PathSettings from_lights = without_visit_limit(settings_);
  LightWalk<EnteringLightKeeper>(scene, from_lights, light_sampler, counters, keeper).run(*sources_);

  TableGatherer gatherer(scene, settings_, *table_, keeper.entered(), sampler, counters);
  const float alpha = CameraWalk<TableGatherer>(scene, settings_, sampler, counters, gatherer).run(camera);
  PixelSample sample = gatherer.result();
  sample.alpha = alpha;
  return sample;
}

void PathTracer::prepare(const Scene& scene, uint64_t, const StopFlag&) {
  if (refraction_) scattering_ = std::make_unique<const RefractiveScattering>(scene, *refraction_);
  if (table_settings_.source == TableSettings::Source::kNone) return;
  table_ = std::make_unique<const TableLight>(scene, table_settings_);
  table_->limit(settings_);
  sources_ = std::make_unique<const LightSources>(scene, true);
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
  std::vector<Parameter> own = connection_parameters("nee", "light");
  own.push_back(word("single_scattering", "path",
                     "light that one smooth boundary of triangles bends before it scatters once: found by paths, or as "
                     "singlescatter finds it",
                     {"path", "refractive"}));
  for (Parameter& parameter : table_parameters()) own.push_back(std::move(parameter));
  return {"volpath",
          {"volpathmis"},
          "path tracing with media: next-event estimation through null boundaries, all channels weighed together",
          with_common_parameters(own),
          [](const Properties& properties) {
            const bool refractive = properties.string("single_scattering") == "refractive";
            const PathSettings path = path_settings(properties);
            const TableSettings table = table_settings(properties, path);
            if (table.source != TableSettings::Source::kNone && (refractive || properties.string("nee") != "standard"))
              properties.refuse("multiple_scattering",
                                "a table goes with single_scattering = path and nee = standard alone");
            return IntegratorSetup{
                std::make_shared<PathTracer>(
                    Kind::kVolumes, path, connection_settings(properties, "nee"),
                    refractive ? std::optional<RefractiveSettings>(std::in_place) : std::nullopt, table),
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
          {word("method", "triangle_intervals",
                "triangle_intervals (where each triangle's light meets the sensor's path), point_sampling (points of "
                "it), straight_line (as if nothing bent light: wrong), none (left out, to see what it adds)",
                {"triangle_intervals", "point_sampling", "straight_line", "none"}),
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
        return IntegratorSetup{
            std::make_shared<PathTracer>(Kind::kVolumes, path_settings(properties), ConnectionSettings{}, refraction),
            false};
      }};
}

}  // namespace turbid
