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
  TableGatherer(const Scene& scene, const PathSettings& settings, const EnteringLights& entering, int table_samples,
                Sampler& sampler, SampleCounters& counters)
      : LightGatherer(scene, settings, {}, nullptr, sampler, counters),
        entering_(entering),
        table_samples_(table_samples),
        sampler_(sampler) {}

  void at_collision(const CollisionEvent& event, const PathState& state, const Traveller& traveller) {
    LightGatherer::at_collision(event, state, traveller);
    Rng rng = sampler_.aside(Purpose::kTableAtCollision, event.position, event.direction);
    const LightByOrder found = entering_.at_collision(event, state, table_samples_, rng);
    for (int order = 0; order < kOrderClasses; ++order) add(order, found.light[order]);
  }

 private:
  const EnteringLights& entering_;
  int table_samples_;
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

PixelSample PathTracer::trace_with_table(const Scene& scene, const SensorRay& camera, Sampler& sampler,
                                         SampleCounters& counters) const {
  TableGatherer gatherer(scene, settings_, *entering_.current(), entering_settings_.samples, sampler, counters);
  const float alpha = CameraWalk<TableGatherer>(scene, settings_, sampler, counters, gatherer).run(camera);
  PixelSample sample = gatherer.result();
  sample.alpha = alpha;
  return sample;
}

/// With tables, in parts whose samples share a set of entering lights.
bool PathTracer::render_pass(const Scene& scene, const Pass& pass, Film& film, const StopFlag& stop) {
  if (!table_) return SamplingIntegrator::render_pass(scene, pass, film, stop);
  const EnteringLightsPlan plan{scene, settings_, *table_, pass.seed};
  const uint64_t end = pass.first_sample + pass.sample_count;
  for (uint64_t first = pass.first_sample; first < end;) {
    const uint64_t next = std::min(end, (EnteringLightSets::set_of(first) + 1) * EnteringLightSets::kReuse);
    SampleCounters counters;
    entering_.prepare(plan, entering_settings_.lights, first, counters);
    add_counters(counters);
    if (!SamplingIntegrator::render_pass(scene, {pass.seed, first, static_cast<uint32_t>(next - first)}, film, stop))
      return false;
    first = next;
  }
  return true;
}

void PathTracer::prepare(const Scene& scene, uint64_t, const StopFlag&) {
  if (refraction_) scattering_ = std::make_unique<const RefractiveScattering>(scene, *refraction_);
  if (table_settings_.source == TableSettings::Source::kNone) return;
  table_ = std::make_unique<const TableLight>(scene, table_settings_);
  table_->limit(settings_);
  entering_.clear();
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
  own.push_back(single_scattering_parameter());
  for (Parameter& parameter : entering_parameters()) own.push_back(std::move(parameter));
  return {"volpath",
          {"volpathmis"},
          "path tracing with media: next-event estimation through null boundaries, all channels weighed together",
          with_common_parameters(own),
          [](const Properties& properties) {
            const PathSettings path = path_settings(properties);
            const TableSettings table = table_settings(properties, path);
            if (table.source != TableSettings::Source::kNone && properties.string("nee") != "standard")
              properties.refuse("multiple_scattering", "a table goes with nee = standard alone");
            return IntegratorSetup{
                std::make_shared<PathTracer>(Kind::kVolumes, path, connection_settings(properties, "nee"),
                                             refraction_settings(properties), table, entering_settings(properties)),
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
