#include "integrator/bdpt_subpaths.h"

namespace turbid {
namespace {

double to_double(float value) { return static_cast<double>(value); }

float weight_of(double others) { return static_cast<float>(1 / (1 + others)); }

}  // namespace

// --- from a light
// -----------------------------------------------------------------------------------------------------

void LightSubpath::at_emitter(const Emission& emission, const Traveller& traveller) {
  LightRecorder::at_emitter(emission, traveller);
  counted_.left(*emission.emitter);
  const PathSettings& settings = context_.settings;
  if (settings.hide_emitters || settings.min_scattering > 0) return;
  const auto arrival = context_.sensor.arrive_from(emission, traveller);
  if (!arrival) return;
  // The only other way to see a light directly is to meet it by chance.
  const EmissionPdf& pdf = emission.ray.pdf;
  const bool sky = emission.emitter->is_environment();
  const float cosine = sky ? 1 : std::abs(dot(emission.ray.ng, normalize(arrival->position - emission.ray.origin)));
  const double by_chance = to_double(arrival->pdf) * end_factor(Spectrum(1.0f), cosine, arrival->proxy);
  const double here = to_double(emission.prob) * to_double(sky ? pdf.pdf_w : pdf.pdf_a);
  sink_->splat(context_.sensor.index_of(arrival->target.pixel), {.value = emission.throughput * arrival->weight,
                                                                 .weight = weight_of(weights_.power(by_chance / here)),
                                                                 .light_vertices = 1,
                                                                 .sensor_vertices = 1});
}

void LightSubpath::at_surface(const SurfaceEvent& event, const PathState& state, const Traveller& traveller) {
  current_ = arrive({event.point.p, Spectrum(1.0f), std::abs(dot(event.point.ng, event.given))}, state);
  if (!(event.object.bsdf->flags() & lobe::kSmooth)) return;
  Vertex& vertex = vertices_.emplace_back(event, state, traveller.medium());
  vertex.sums = current_;
  vertex.bent = counted_.is_bent();
  join_with_sensor(vertex, traveller);
}

void LightSubpath::at_collision(const CollisionEvent& event, const PathState& state, const Traveller& traveller) {
  Vertex& vertex = vertices_.emplace_back(event, state);
  counted_.collided(event.medium);
  vertex.bent = counted_.is_bent();
  vertex.sums = current_ = arrive({event.position, vertex.events}, state);
  join_with_sensor(vertex, traveller);
}

void LightSubpath::join_with_sensor(const Vertex& vertex, const Traveller& traveller) {
  if (!context_.settings.order_counts(vertex.order) || turbid::counted_elsewhere(vertex.bent, vertex.order)) return;
  const auto way = context_.sensor.way_from(vertex.position);
  if (!way) return;
  const Vec3 wo = normalize(way->position - vertex.position);
  const Vertex::Scattering scattered = vertex.scatter(wo, TransportMode::kImportance);
  const Spectrum flux = vertex.throughput * scattered.value;
  const auto event = vertex.surface_event();
  const SurfaceEvent* surface = event ? &*event : nullptr;
  const auto arrival = context_.sensor.arrive(*way, vertex.leave(wo), flux, traveller, surface);
  if (!arrival) return;
  const double pdf = to_double(arrival->pdf) * end_factor(vertex, wo, arrival->proxy);
  sink_->splat(context_.sensor.index_of(arrival->target.pixel),
               {.value = flux * arrival->weight,
                .weight = weight_of(
                    weights_.others(current_, pdf, to_double(scattered.pdf_back_w), merged_at(weights_, vertex, wo))),
                .light_vertices = vertex.depth + 1,
                .sensor_vertices = 1,
                .order = vertex.order});
}

// --- from the sensor
// --------------------------------------------------------------------------------------------------

void SensorSubpath::gather(const Spectrum& value, double others, int light_vertices, int sensor_vertices, int order) {
  sink_->gather({.value = value,
                 .weight = weight_of(others),
                 .light_vertices = light_vertices,
                 .sensor_vertices = sensor_vertices,
                 .order = order});
}

/// Without joins chance is the only way to paths that have no vertex to merge at, and no way to others.
void SensorSubpath::gather_by_chance(const Spectrum& value, double others, const PathState& state) {
  if (!weights_.joins() && others > 0) return;
  gather(value, others, 0, state.depth + 1, state.order);
}

void SensorSubpath::before_flight(const Medium& medium, const PathState& state, const Traveller& traveller) {
  if (!refraction_) return;
  sink_->gather({.value = refraction_->before_flight(medium, state, traveller),
                 .light_vertices = 2,  // the light and P; V is the sensor's
                 .sensor_vertices = state.depth + 2,
                 .order = 1});
}

void SensorSubpath::on_segment(const Ray& way, const Medium& medium, const PathState& state,
                               const Traveller::Leg& leg) {
  SubpathRecorder::on_segment(way, medium, state, leg);
  if (!medium.emits() || (state.depth == 0 && context_.settings.hide_emitters)) return;
  if (!context_.settings.order_counts(state.order)) return;
  gather(state.throughput * leg.emission, 0, 0, state.depth + 2, state.order);
}

/// At the first vertex: light paths that are joined with the sensor against the sensor's ray.
StrategySums SensorSubpath::first_sums(const EdgeEnd& end, const Spectrum& straight) const {
  const auto way = context_.scene.sensor().connect(end.position, u_aperture_);
  if (!way) return {};
  const double pdf = to_double(context_.sensor.pdf(*way)) * end_factor(end.events, end.cosine, straight);
  return {1 / pdf, weights_.joins() ? 1.0 : 0.0, 0};
}

void SensorSubpath::at_light(const Hit& hit, const Object& object, const SurfacePoint& point, const PathState& state,
                             const Traveller& traveller) {
  if (!context_.settings.order_counts(state.order) || (state.depth == 1 && context_.settings.hide_emitters)) return;
  if (counted_elsewhere(false)) return;
  const SurfaceEmitter& emitter = *object.emitter;
  const Vec3 wo = -traveller.ray().direction;
  const Spectrum Le = emitter.Le(point, wo);
  if (Le.is_black()) return;
  const size_t index = context_.scene.emitter_index(hit);
  const float cosine = std::abs(dot(point.ng, wo));
  const StrategySums sums = arrive({point.p, Spectrum(1.0f), cosine}, state.depth, straight_);
  const EmissionPdf emission = emitter.emission_pdf(point.ng, wo);
  const double start = to_double(context_.sources.prob(index)) * to_double(emission.pdf_a) * sums.inverse_pdf;
  double others = weights_.power(start);
  if (state.depth == 1) {
    others *= sums.joint;  // light joined with the sensor
  } else {
    const double direct_a = to_double(context_.scene.choice_prob(index)) *
                            to_double(emitter.pdf_direct_w(edge_.from.position, point.p, point.ng)) *
                            to_double(cosine) * inverse_square(point.p, edge_.from.position);
    others = weights_.power(direct_a * sums.inverse_pdf) * sums.joint +
             others * weights_.power(to_double(emission.pdf_w)) * sums.behind;
  }
  gather_by_chance(state.throughput * Le, others, state);
}

void SensorSubpath::at_escape(const PathState& state, const Traveller& traveller) {
  if (!context_.settings.order_counts(state.order) || (state.depth == 1 && context_.settings.hide_emitters)) return;
  if (counted_elsewhere(true)) return;
  const Vec3& direction = traveller.ray().direction;
  const double through = end_factor(Spectrum(1.0f), 1, straight_);
  for (const ChosenEnvironment& sky : context_.scene.environments()) {
    const Spectrum Le = sky.emitter->Le(direction);
    if (Le.is_black()) continue;
    const EmissionPdf emission = sky.emitter->emission_pdf({}, -direction);
    const double start = to_double(context_.sources.prob(sky.index)) * to_double(emission.pdf_w);
    double others = 0;
    if (state.depth == 1 && weights_.joins()) {
      if (const auto way = context_.scene.sensor().connect_to_infinity(direction, u_aperture_))
        others = weights_.power(start / (to_double(context_.sensor.pdf(*way)) * through));
    } else if (state.depth > 1) {
      const StrategySums sums = weights_.next(edge_.sums, edge_.by, through, edge_.back_factor(straight_));
      const double direct_w = to_double(sky.prob) * to_double(sky.emitter->pdf_direct_w(direction));
      others = weights_.power(direct_w * sums.inverse_pdf) * sums.joint +
               weights_.power(start * sums.inverse_pdf) * weights_.power(to_double(emission.pdf_a)) * sums.behind;
    }
    gather_by_chance(state.throughput * Le, others, state);
  }
}

Vertex SensorSubpath::reach(const SurfaceEvent& event, const PathState& state, const Traveller& traveller) {
  Vertex vertex(event, state, traveller.medium());
  vertex.sums = current_ =
      arrive({event.point.p, Spectrum(1.0f), std::abs(dot(event.point.ng, event.given))}, state.depth, straight_);
  return vertex;
}

Vertex SensorSubpath::reach(const CollisionEvent& event, const PathState& state) {
  Vertex vertex(event, state);
  vertex.sums = current_ = arrive({event.position, vertex.events}, state.depth, straight_);
  return vertex;
}

void SensorSubpath::connect(const Vertex& vertex, const Traveller& traveller) {
  if (!weights_.joins()) return;
  if (vertex.is_surface() || !traveller.blind()) estimate_direct(vertex, traveller);
  join(vertex, traveller);
}

void SensorSubpath::at_surface(const SurfaceEvent& event, const PathState& state, const Traveller& traveller) {
  const Vertex vertex = reach(event, state, traveller);
  if (event.object.bsdf->flags() & lobe::kSmooth) connect(vertex, traveller);
}

void SensorSubpath::at_collision(const CollisionEvent& event, const PathState& state, const Traveller& traveller) {
  connect(reach(event, state), traveller);
}

void SensorSubpath::estimate_direct(const Vertex& vertex, const Traveller& traveller) {
  float u_light = sampler_.next_1d();
  const Vec2 u = sampler_.next_2d();
  const EmitterChoice choice = context_.scene.choose_emitter(u_light);
  if (!choice.emitter || !context_.settings.order_counts(vertex.order)) return;
  const auto light = choice.emitter->sample_direct(vertex.position, u);
  if (!light) return;
  const Vertex::Scattering scattered = vertex.scatter(light->wi, TransportMode::kRadiance);
  const Spectrum towards = vertex.throughput * scattered.value * light->weight / choice.prob;
  if (towards.is_black()) return;
  const auto event = vertex.surface_event();
  const SurfaceEvent* surface = event ? &*event : nullptr;
  const Passage passage = traveller.look_along(ray_to_light(*light, vertex.leave(light->wi)), Spectrum(1.0f), surface);
  if (passage.prob == 0) return;
  gather(towards * passage.transmittance, others_of_direct(vertex, choice, *light, scattered, passage.proxy), 1,
         vertex.depth + 1, vertex.order);
}

double SensorSubpath::others_of_direct(const Vertex& vertex, const EmitterChoice& choice,
                                       const DirectLightSample& light, const Vertex::Scattering& scattered,
                                       const Spectrum& proxy) const {
  const Emitter& emitter = *choice.emitter;
  const EmissionPdf emission = emitter.emission_pdf(light.ng, -light.wi);
  const double direct = to_double(choice.prob) * (light.delta ? 1 : to_double(light.pdf_w));
  double others = 0;
  if (!light.delta) others = weights_.power(to_double(scattered.pdf_w) * end_factor(Spectrum(1.0f), 1, proxy) / direct);
  // The light's walk starts there and comes here, against asking from here: both over the same point of the light.
  double walk = to_double(context_.sources.prob(choice.index)) * end_factor(vertex, light.wi, proxy);
  if (emitter.is_at_infinity()) {
    walk *= to_double(emission.pdf_a) * (light.delta ? 1 : to_double(emission.pdf_w));
  } else {
    walk *= to_double(emission.pdf_w);
    walk *= light.delta ? inverse_square(vertex.position, light.position)
                        : to_double(emission.pdf_a) / to_double(std::abs(dot(light.ng, light.wi)));
  }
  return others + weights_.others(vertex.sums, walk / direct, to_double(scattered.pdf_back_w),
                                  merged_at(weights_, vertex, light.wi));
}

/// Both ends are in the midst of a visit to one medium: together they have made so many collisions there.
bool SensorSubpath::visit_counts(const Vertex& vertex, const Vertex& light) const {
  if (context_.settings.limited_media.empty()) return true;
  const Vec3 way = light.position - vertex.position;
  return context_.settings.visit_counts(vertex.medium_towards(way),
                                        vertex.visit_order_towards(way) + light.visit_order_towards(-way));
}

/// Of the lines that make paths of k edges min(1, connections / k) are taken, systematically: the number does not
/// depend on how far the light's subpath was followed.
void SensorSubpath::join(const Vertex& vertex, const Traveller& traveller) {
  float sum = selection_.next_float();
  for (const Vertex& light : light_vertices_) {
    const int edges = vertex.depth + light.depth + 1;
    const float prob = std::min(1.0f, context_.connections / static_cast<float>(edges));
    sum += prob;
    if (sum < 1) continue;
    sum -= 1;
    if (edges > context_.settings.max_depth) return;
    const int order = vertex.order + light.order;
    if (!context_.settings.order_counts(order) || turbid::counted_elsewhere(light.bent, order)) continue;
    if (!visit_counts(vertex, light)) continue;
    ++context_.counters.connections;
    const auto joined = turbid::join(context_.scene, weights_, vertex, light, traveller);
    if (joined) gather(joined->value / prob, joined->others, light.depth + 1, vertex.depth + 1, order);
  }
}

}  // namespace turbid
