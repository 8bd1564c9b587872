#include "integrator/table_light.h"

#include <fmt/format.h>

#include <stdexcept>

#include "core/log.h"
#include "gathering/sensor_gatherer.h"
#include "integrator/walked_scattering.h"
#include "manylight/segment_pair.h"
#include "manylight/volume_points.h"

namespace turbid {

std::vector<Parameter> table_parameters() {
  return {word("multiple_scattering", "path",
               "light that scatters from_order times or more in one visit to a homogeneous medium: path (by this "
               "method), table (looked up, as if the medium had no end), model (by random walks in a medium without "
               "end, to check the table)",
               {"path", "table", "model"}),
          word("table_mode", "exact",
               "how the table keeps its light: exact (spherical harmonics, one table for all albedos of a phase "
               "function), seed (sampled lobes in a quadtree, one for each material, as published), seed_computed (its "
               "lobes "
               "before they are sampled: 50 MB, built for each render)",
               {"exact", "seed", "seed_computed"}),
          {"from_order",
           ParameterType::kInteger,
           "3",
           "collisions in one visit from which on the table has them; 2: those of two collisions are found from what "
           "the table is fed by, too",
           {.min = 2, .max = 5}},
          word("boundary", "none",
               "what becomes of the table's light at the boundary of the medium: none (it goes on as if the medium had "
               "no end), image (mirrored sources at the boundaries around correct it), measured (weighed against what "
               "walks from the lights bring out of each part of the medium)",
               {"none", "image", "measured"})};
}

TableSettings table_settings(const Properties& properties, const PathSettings& path) {
  TableSettings settings;
  const std::string source = properties.string("multiple_scattering");
  settings.from_order = static_cast<int>(properties.integer("from_order"));
  const std::string mode = properties.string("table_mode");
  if (mode == "seed") settings.mode = TableSettings::Mode::kSeed;
  if (mode == "seed_computed") settings.mode = TableSettings::Mode::kSeedComputed;
  if (source == "path") return settings;
  settings.source = source == "table" ? TableSettings::Source::kTable : TableSettings::Source::kModel;
  if (properties.string("single_scattering") == "refractive")
    properties.refuse("multiple_scattering", "a table goes with single_scattering = path alone");
  settings.images = properties.string("boundary") == "image";
  settings.measured = properties.string("boundary") == "measured";
  if ((settings.images || settings.measured) && source == "model")
    properties.refuse("boundary", "the model is that of a medium without end");
  const int first = settings.table_order();
  const std::string whole = fmt::format("the table holds all orders from {} on at once (from_order): ", first);
  if (path.max_scattering != PathSettings::kUnlimited && path.max_scattering >= first)
    properties.refuse("max_scattering", whole + "use a limit below that, or -1");
  if (path.min_scattering > first) properties.refuse("min_scattering", whole + "use a limit up to that");
  return settings;
}

namespace {

/// Some boundary of the medium lets light through in a choice of directions.
bool has_rough_boundary(const Scene& scene, const Medium* medium) {
  constexpr lobe::Flags kRough = lobe::kSmooth | lobe::kTransmission;
  return std::any_of(scene.objects().begin(), scene.objects().end(), [&](const Object& object) {
    return (object.interior.get() == medium || object.exterior.get() == medium) &&
           (object.bsdf->flags() & kRough) == kRough;
  });
}

/// One around the boundary of each medium that has an inside.
std::vector<Ball> balls_around(const Scene& scene, const std::vector<const Medium*>& media) {
  std::vector<Ball> balls;
  for (const Medium* medium : media) {
    Bounds3 box;
    for (const Object& object : scene.objects())
      if (object.bounds_media && object.interior.get() == medium) box.extendBy(object.shape->bounds());
    if (!box.isEmpty()) balls.push_back({box.center(), length(box.size()) / 2});
  }
  return balls;
}

}  // namespace

TableLight::TableLight(const Scene& scene, const TableSettings& settings) : settings_(settings) {
  for (const Surroundings& surroundings : scene.media()) {
    const HomogeneousMedium* medium = surroundings.medium->as_homogeneous();
    if (!medium) {
      log_warning("multiple scattering in media that vary is left to the method: tables are for homogeneous ones");
      continue;
    }
    if (medium->sigma_s().is_black()) continue;
    if (!settings.behind_rough && has_rough_boundary(scene, medium)) {
      log_warning("multiple scattering behind rough boundaries is left to the method, which stops there");
      continue;
    }
    try {
      const bool walks = settings.source == TableSettings::Source::kModel;
      if (walks && medium->albedo().max() > static_cast<float>(kLargestAlbedo))
        throw std::invalid_argument(fmt::format("walks without end need an albedo of at most {}", kLargestAlbedo));
      entries_.push_back({medium, walks ? nullptr : find_scattering(*medium)});
    } catch (const std::invalid_argument& error) {
      log_warning(fmt::format("multiple scattering in a medium is left to the method: {}", error.what()));
    }
  }
  if (settings.images) boundaries_.emplace(scene, media());
  sources_.emplace(scene, true, balls_around(scene, media()));
}

std::unique_ptr<const MultipleScattering> TableLight::find_scattering(const HomogeneousMedium& medium) const {
  if (settings_.mode == TableSettings::Mode::kExact)
    return std::make_unique<const MultipleScattering>(medium, *find_table(medium.phase(), settings_.request),
                                                      settings_.table_order());
  QuadtreeSettings photons = settings_.photons;
  photons.from_order = settings_.table_order();
  if (settings_.mode == TableSettings::Mode::kSeedComputed) {
    std::array<PhotonLobes, kSourceKinds> lobes = simulate_photons(medium.phase(), medium.albedo(), photons);
    return std::make_unique<const MultipleScattering>(
        medium, quadtree_lights({std::make_shared<const PhotonLobes>(std::move(lobes[0])),
                                 std::make_shared<const PhotonLobes>(std::move(lobes[1]))}));
  }
  return std::make_unique<const MultipleScattering>(
      medium, quadtree_lights(find_quadtree(medium.phase(), medium.albedo(), photons, settings_.request.folder)));
}

std::vector<const Medium*> TableLight::media() const {
  std::vector<const Medium*> result;
  for (const Entry& entry : entries_) result.push_back(entry.medium);
  return result;
}

const TableLight::Entry* TableLight::find(const Medium* medium) const {
  for (const Entry& entry : entries_)
    if (entry.medium == medium) return &entry;
  return nullptr;
}

std::optional<BoundaryPlane> TableLight::entry_of(const Stretch& way, const Medium& medium) const {
  if (!boundaries_) return std::nullopt;
  constexpr float kInside = 1e-3f;  // of the way: back from there
  return boundaries_->towards({way.origin + way.direction * (kInside * way.length), -way.direction}, medium);
}

Spectrum TableLight::source_radiance(const EnteringLight& light, const BoundaryPlanes& boundaries, const Vec3& x,
                                     const Vec3& w, Rng& rng) const {
  const Entry* entry = find(light.medium);
  if (!entry) return Spectrum(0.0f);
  if (!boundaries.empty()) {
    BoundaryPlanes planes = boundaries;
    if (light.entry) add_boundary(*light.entry, planes);
    return light.flux * bounded_source_radiance(*entry->scattering, light.way, planes, x, w);
  }
  return light.flux * (entry->scattering
                           ? entry->scattering->source_radiance(light.way, x, w)
                           : walk_source_radiance(*entry->medium, settings_.table_order(), light.way, x, w, rng));
}

Spectrum TableLight::twice_scattered(const EnteringLight& light, const Vec3& x, const Vec3& w, float u) const {
  constexpr float kLongest = 40;  // mean free paths: further along nothing sets out any more
  const HomogeneousMedium& medium = *light.medium->as_homogeneous();
  const Ray way{light.way.origin, light.way.direction, std::min(light.way.length, kLongest / medium.sigma_t().min())};
  const PlaceOnSegment place = place_towards(way, x, medium.phase().mean_cosine(), u);
  const Vec3 y = way.at(place.t), line = x - y;
  const float distance = length(line);
  if (!(place.pdf_t > 0) || !(distance > 0)) return Spectrum(0.0f);
  if (boundaries_ && !boundaries_->lets_see(y, x)) return Spectrum(0.0f);
  const Vec3 direction = line / distance;
  const float lobes = medium.phase().eval(dot(way.direction, direction)) * medium.phase().eval(dot(direction, w));
  return light.flux * medium.transmittance(place.t + distance) * medium.sigma_s() * medium.sigma_s() *
         static_cast<float>(static_cast<double>(lobes) / (sqr(static_cast<double>(distance)) * place.pdf_t));
}

Spectrum TableLight::seen_by(const PathState& state, const CollisionEvent& event, const Spectrum& source) {
  const Spectrum sigma_s = event.medium.sigma_s_at(event.position);
  Spectrum value(0.0f);
  for (int c = 0; c < kChannels; ++c)
    if (sigma_s[c] > 0) value[c] = state.throughput[c] * source[c] / sigma_s[c];
  return value;
}

Spectrum TableLight::looked_up(const EnteringLight& light, const BoundaryPlanes& boundaries,
                               const CollisionEvent& event, const PathState& state, Rng& rng) const {
  return seen_by(state, event, source_radiance(light, boundaries, event.position, -event.direction, rng));
}

void TableLight::at_collision(const EnteringLight& light, const BoundaryPlanes& boundaries, const CollisionEvent& event,
                              const PathState& state, const PathSettings& path, const Spectrum& balance, float scale,
                              Rng& rng, LightByOrder& sum) const {
  if (light.medium != &event.medium) return;
  const int before = light.order + state.order - 1;
  if (settings_.from_order == 2 && counts(light, 2, state.depth, state.order, path))
    sum.add(before + 2,
            seen_by(state, event, twice_scattered(light, event.position, -event.direction, rng.next_float())) * scale);
  if (counts(light, settings_.table_order(), state.depth, state.order, path))
    sum.add(before + settings_.table_order(), looked_up(light, boundaries, event, state, rng) * balance * scale);
}

Spectrum TableLight::along(const EnteringLight& light, const BoundaryPlanes& boundaries, const Ray& way,
                           const PathState& state, const PathSettings& path, const LightBalance& balance,
                           Rng& rng) const {
  const Entry* entry = find(light.medium);
  if (!entry || !counts(light, settings_.table_order(), state.depth + 1, state.order + 1, path)) return Spectrum(0.0f);
  const Stretch view{way.origin, way.direction, way.t_max};
  if (entry->scattering && boundaries.empty() && !settings_.measured)
    return state.throughput * light.flux * entry->scattering->radiance(light.way, view, rng.next_float(), 1);
  const auto at = collide_before(*entry->medium, way.t_max, channel_mix(state.throughput), rng.next_float());
  if (!std::isfinite(at.t) || !(at.pdf_t > 0)) return Spectrum(0.0f);
  return state.throughput * entry->medium->transmittance(at.t) / at.pdf_t *
         source_radiance(light, boundaries, way.at(at.t), -way.direction, rng) *
         balance.at(way.at(at.t), -way.direction);
}

void EnteringLightKeeper::on_segment(const Ray& way, const Medium& medium, const PathState& state,
                                     const Traveller::Leg& leg) {
  if (state.visit_order > 0 || state.throughput.is_black() || !table_.holds(&medium)) return;
  const float length = leg.collides ? length_to_surface(scene_, way, medium, counters_) : way.t_max;
  if (!(length > 0)) return;
  const Stretch stretch{way.origin, way.direction, length};
  entered_.push_back({stretch, state.throughput * (scale_ * roulette_.scale()), &medium, state.depth, state.order,
                      table_.entry_of(stretch, medium)});
}

void EnteringLightKeeper::left_medium(const Object& object, const SurfacePoint& point, const Vec3& given,
                                      const PathState& state) {
  if (!table_.measured() || state.visit_order < table_.table_order() || !table_.holds(last_medium_)) return;
  left_.push_back({last_medium_,
                   point.p,
                   {&object, dot(given, point.ng) > 0},
                   {last_, last_direction_, state.throughput * (scale_ * roulette_.scale())}});
}

}  // namespace turbid
