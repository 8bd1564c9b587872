#include "integrator/light_splatter.h"

namespace turbid {
namespace {

Vec2 next_2d(Rng& rng) {
  const float u = rng.next_float();
  return {u, rng.next_float()};
}

}  // namespace

LightSplatter::LightSplatter(const Scene& scene, const PathSettings& settings, const ConnectionSettings& connection,
                             const Sampler& sampler, SampleCounters& counters)
    : scene_(scene),
      settings_(settings),
      // Whether a sensor has an aperture does not depend on the numbers.
      maker_(scene, scene.sensor().aperture_point(Vec2(0.5f)) ? connection : ConnectionSettings{}),
      sampler_(sampler),
      connector_(scene, static_cast<double>(pixel_count(scene.film())), sampler, counters) {}

bool LightSplatter::may_insert(const PathState& state) const {
  return state.depth + 2 <= settings_.max_depth && settings_.order_counts(state.order + 1);
}

// --- the vertices of the walk
// -----------------------------------------------------------------------------------------

void LightSplatter::at_emitter(const Emission& emission, const Traveller& traveller) {
  start_edge();
  const EmissionSample& ray = emission.ray;
  if (!settings_.hide_emitters && settings_.min_scattering == 0)
    if (const auto arrival = connector_.arrive_from(emission, traveller))
      splat(*arrival, emission.throughput, 1, {emission.throughput, 0, 0}, 0);

  const bool open = emission.emitter->emission_towards(ray, ray.direction).has_value();
  expected_ = maker_.expected(traveller.medium());
  const PathState start{emission.throughput, 0, 0};
  if (open)
    insert_from(ray.origin, start, traveller, nullptr, [&](const Vec3& direction) {
      return Leaving{ray.origin, *emission.emitter->emission_towards(ray, direction) / emission.prob,
                     emission.emitter->emission_pdf(ray.ng, direction).pdf_w};
    });
  depart({ray.origin, expected_, open, open ? ray.pdf.pdf_w : 1}, start, traveller);
}

void LightSplatter::at_surface(const SurfaceEvent& event, const PathState& state, const Traveller& traveller) {
  expected_ = maker_.expected(event.object, traveller.medium());
  if (!(event.object.bsdf->flags() & lobe::kSmooth)) return;
  const Vertex vertex(event, state, traveller.medium());
  join_with_sensor(vertex, false, traveller);
  insert_from_vertex(vertex, state, traveller);
}

void LightSplatter::at_collision(const CollisionEvent& event, const PathState& state, const Traveller& traveller) {
  const Vertex vertex(event, state);
  join_with_sensor(vertex, last_.medium && &last_.medium->phase() == &event.medium.phase(), traveller);
  expected_ = maker_.expected(&event.medium);
  insert_from_vertex(vertex, state, traveller);
}

void LightSplatter::left_surface(const SurfaceEvent& event, const BsdfSample& sample, const Vec3&,
                                 const PathState& state, const Traveller& traveller) {
  const bool open = !(sample.flags & lobe::kDelta);
  depart({event.point.p, expected_, open, open ? sample.pdf_w : 1}, state, traveller);
}

void LightSplatter::left_collision(const CollisionEvent& event, float mu, const Vec3&, const PathState& state,
                                   const Traveller& traveller) {
  depart({event.position, expected_, true, event.medium.phase().eval(mu)}, state, traveller);
}

// --- the techniques
// ---------------------------------------------------------------------------------------------------

/// `shared`: other techniques could have made the vertex.
void LightSplatter::join_with_sensor(const Vertex& vertex, bool shared, const Traveller& traveller) {
  if (!settings_.order_counts(vertex.order)) return;
  const auto way = connector_.way_from(vertex.position);
  if (!way) return;
  double weight_here = 1;
  if (shared) {
    const Edge edge{last_, -vertex.given, length(vertex.position - last_.position), vertex.events, straight_};
    weight_here = maker_.walk_weight(edge, end_at(connector_.aperture_numbers(vertex.position)));
    if (weight_here == 0) return;
  }
  const Vec3 wo = normalize(way->position - vertex.position);
  const Spectrum flux = vertex.throughput * vertex.scatter(wo, TransportMode::kImportance).value;
  const auto surface = vertex.surface_event();
  if (const auto arrival = connector_.arrive(*way, vertex.leave(wo), flux, traveller, surface ? &*surface : nullptr))
    splat(*arrival, flux, weight_here, {flux, vertex.depth, vertex.order}, 0);
}

void LightSplatter::insert_from_vertex(const Vertex& vertex, const PathState& state, const Traveller& traveller) {
  const auto surface = vertex.surface_event();
  insert_from(vertex.position, state, traveller, surface ? &*surface : nullptr, [&](const Vec3& direction) {
    const Vertex::Scattering scattered = vertex.scatter(direction, TransportMode::kImportance);
    return Leaving{vertex.leave(direction), vertex.throughput * scattered.value, scattered.pdf_w};
  });
}

template <class Leave>
void LightSplatter::insert_from(const Vec3& x0, const PathState& state, const Traveller& traveller,
                                const SurfaceEvent* surface, const Leave& leave) {
  Departure from{x0, expected_, true};
  if (!maker_.inserts(from) || !may_insert(state)) return;
  Rng rng = sampler_.aside(Purpose::kInsertedCollision, x0);
  const Vec2 u_aperture = next_2d(rng), u = next_2d(rng);
  const PathEnd end = end_at(u_aperture);
  const auto x1 = maker_.insert(from, end, u.x, u.y, rng.next_float());
  if (!x1) return;
  const Leaving leaving = leave(x1->arrives);
  const auto way = scene_.sensor().connect(x1->position, u_aperture);
  if (leaving.flux.is_black() || !way) return;
  const Passage passage = traveller.look_along(line_to(leaving.origin, x1->position), leaving.flux, surface);
  if (!scatters_as_expected(from, passage)) return;
  from.pdf_w = leaving.pdf_w;
  double factor = inverse_square(x0, x1->position) / x1->pdf_v;
  if (maker_.weighs()) {
    const Edge edge{from, x1->arrives, x1->d1, passage.medium->proxy_sigma_t(x1->position), passage.proxy};
    factor *= ConnectionSampler::weight(x1->pdf_v, maker_.densities(edge, end, x1->pdf_v));
  }
  finish(x1->position, *passage.medium, leaving.flux * passage.transmittance * x1->f, *way, factor, state);
}

/// The walk leaves x0: the edge that begins has another end, made for the sensor.
void LightSplatter::depart(const Departure& from, const PathState& state, const Traveller& traveller) {
  last_ = from;
  start_edge();
  if (!maker_.marches(from) || !may_insert(state) || state.throughput.is_black()) return;
  Rng rng = sampler_.aside(Purpose::kMarchedCollision, from.position);
  const Vec2 u_aperture = next_2d(rng);
  const PathEnd end = end_at(u_aperture);
  const Vec3& direction = traveller.ray().direction;
  const auto distance = maker_.march(from, direction, end, rng.next_float());
  if (!distance) return;
  const Vec3 x1 = from.position + direction * distance->t;
  const auto way = scene_.sensor().connect(x1, u_aperture);
  if (!way) return;
  const Passage passage = traveller.look_along({traveller.ray().origin, direction, distance->t}, state.throughput);
  if (!scatters_as_expected(from, passage)) return;
  const float f = passage.medium->phase().eval_angle(static_cast<float>(angle_between(direction, end.place - x1)));
  double factor = 1 / distance->pdf_t;
  if (maker_.weighs()) {
    const Edge edge{from, direction, distance->t, passage.medium->proxy_sigma_t(x1), passage.proxy};
    const CollisionDensities all = maker_.densities(edge, end);
    factor *= ConnectionSampler::weight(all.along, all);
  }
  finish(x1, *passage.medium, state.throughput * passage.transmittance * f, *way, factor, state);
}

/// From the inserted collision on to the sensor.
void LightSplatter::finish(const Vec3& x1, const Medium& medium, const Spectrum& arrived, const SensorConnection& way,
                           double factor, const PathState& state) {
  const Spectrum flux = arrived * medium.sigma_s_at(x1) * static_cast<float>(factor);
  if (const auto arrival = connector_.arrive(way, x1, flux, &medium)) splat(*arrival, flux, 1, state, 1);
}

void LightSplatter::splat(const SensorArrival& arrival, const Spectrum& flux, double weight_here,
                          const PathState& state, int added) {
  sink_->splat(connector_.index_of(arrival.target.pixel), {.value = flux * arrival.weight,
                                                           .weight = static_cast<float>(weight_here),
                                                           .light_vertices = state.depth + 1 + added,
                                                           .sensor_vertices = 1,
                                                           .order = state.order + added});
}

}  // namespace turbid
