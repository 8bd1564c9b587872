#include "integrator/light_splatter.h"

namespace turbid {
namespace {

Vec2 next_2d(Rng& rng) {
  const float u = rng.next_float();
  return {u, rng.next_float()};
}

/// Distances along a ray in proportion to 1 / (distance to a point)^2, from 0 to infinity (Kulla & Fajardo 2012).
struct Equiangular {
  float delta, height, first;  ///< of the foot of the perpendicular; its length; the angle at distance 0

  Equiangular(const Vec3& origin, const Vec3& direction, const Vec3& point)
      : delta(dot(point - origin, direction)),
        height(length(point - origin - direction * delta)),
        first(std::atan2(-delta, height)) {}

  float sample(float u) const { return delta + height * std::tan(first + u * (kPi / 2 - first)); }
  float pdf_t(float t) const {
    const float square = height * height + sqr(t - delta);
    return square > 0 ? height / ((kPi / 2 - first) * square) : 0;
  }
};

}  // namespace

LightSplatter::LightSplatter(const Scene& scene, const PathSettings& settings,
                             const CameraConnectionSettings& connection, const Sampler& sampler,
                             SampleCounters& counters)
    : scene_(scene),
      settings_(settings),
      connection_(connection.technique),
      insertion_(connection.insertion),
      sampler_(sampler),
      connector_(scene, static_cast<double>(pixel_count(scene.film())), sampler, counters) {}

// --- which techniques there are
// ---------------------------------------------------------------------------------------

const PhaseFunction* LightSplatter::phase_around(const Medium* medium) const {
  const bool possible = connection_ != CameraConnection::kStandard && medium && !scene_.has_priorities() &&
                        scene_.sensor().aperture_point(Vec2(0.5f));
  return possible ? &medium->phase() : nullptr;
}

const PhaseFunction* LightSplatter::phase_around(const Object& object, const Medium* medium) const {
  if (!medium && object.bounds_media) medium = object.interior ? object.interior.get() : object.exterior.get();
  return object.bsdf->flags() & lobe::kSmooth ? phase_around(medium) : nullptr;
}

bool LightSplatter::may_insert(const PathState& state) const {
  return state.depth + 2 <= settings_.max_depth && settings_.order_counts(state.order + 1);
}

LightSplatter::Densities LightSplatter::densities(const PhaseFunction& phase, const Vec3& x0, const Vec3& x1,
                                                  const Vec3& x2, float pdf_w, const Spectrum& sigma,
                                                  const Spectrum& proxy) const {
  const double by_direction = static_cast<double>(pdf_w) * inverse_square(x0, x1);
  Densities result;
  result.walk = by_direction * end_factor(sigma, 1, proxy);
  if (connection_ != CameraConnection::kOnceMore) {
    const float d1 = length(x1 - x0);
    result.equiangular = by_direction * static_cast<double>(Equiangular(x0, (x1 - x0) / d1, x2).pdf_t(d1));
  }
  if (connection_ != CameraConnection::kEquiangular) result.once_more = insertion_pdf_v(phase, x0, x1, x2, insertion_);
  return result;
}

double LightSplatter::weight(Technique technique, const Densities& d) const {
  const double own = technique == Technique::kWalk          ? d.walk
                     : technique == Technique::kEquiangular ? d.equiangular
                                                            : d.once_more;
  if (connection_ == CameraConnection::kMis) {
    const double sum = d.walk * d.walk + d.equiangular * d.equiangular + d.once_more * d.once_more;
    return sum > 0 ? own * own / sum : 0;
  }
  if (technique != Technique::kWalk) return 1;
  return d.equiangular + d.once_more > 0 ? 0 : 1;
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
  current_phase_ = open ? phase_around(traveller.medium()) : nullptr;
  const PathState start{emission.throughput, 0, 0};
  insert_from(ray.origin, start, traveller, nullptr, [&](const Vec3& direction) {
    return Leaving{ray.origin, *emission.emitter->emission_towards(ray, direction) / emission.prob,
                   emission.emitter->emission_pdf(ray.ng, direction).pdf_w};
  });
  depart(ray.origin, ray.pdf.pdf_w, start, traveller);
}

void LightSplatter::at_surface(const SurfaceEvent& event, const PathState& state, const Traveller& traveller) {
  current_phase_ = phase_around(event.object, traveller.medium());
  if (!(event.object.bsdf->flags() & lobe::kSmooth)) return;
  const Vertex vertex(event, state, traveller.medium());
  join_with_sensor(vertex, nullptr, traveller);
  insert_from_vertex(vertex, state, traveller);
}

void LightSplatter::at_collision(const CollisionEvent& event, const PathState& state, const Traveller& traveller) {
  const Vertex vertex(event, state);
  join_with_sensor(vertex, last_phase_ == &event.medium.phase() ? last_phase_ : nullptr, traveller);
  current_phase_ = phase_around(&event.medium);
  insert_from_vertex(vertex, state, traveller);
}

void LightSplatter::left_surface(const SurfaceEvent& event, const BsdfSample& sample, const Vec3&,
                                 const PathState& state, const Traveller& traveller) {
  if (sample.flags & lobe::kDelta) current_phase_ = nullptr;
  depart(event.point.p, sample.pdf_w, state, traveller);
}

void LightSplatter::left_collision(const CollisionEvent& event, float mu, const Vec3&, const PathState& state,
                                   const Traveller& traveller) {
  depart(event.position, event.medium.phase().eval(mu), state, traveller);
}

// --- the techniques
// ---------------------------------------------------------------------------------------------------

/// A vertex of the walk; `shared`: the phase function of the other techniques that could have made it, or null.
void LightSplatter::join_with_sensor(const Vertex& vertex, const PhaseFunction* shared, const Traveller& traveller) {
  if (!settings_.order_counts(vertex.order)) return;
  const auto way = connector_.way_from(vertex.position);
  if (!way) return;
  double weight_here = 1;
  if (shared) {
    weight_here = weight(Technique::kWalk, densities(*shared, last_position_, vertex.position, way->position,
                                                     last_pdf_w_, vertex.events, straight_));
    if (weight_here == 0) return;
  }
  const Vec3 wo = normalize(way->position - vertex.position);
  const Spectrum flux = vertex.throughput * vertex.scatter(wo, TransportMode::kImportance).value;
  std::optional<SurfaceEvent> event;
  const SurfaceEvent* surface = vertex.is_surface() ? &event.emplace(vertex.surface_event()) : nullptr;
  if (const auto arrival = connector_.arrive(*way, vertex.leave(wo), flux, traveller, surface))
    splat(*arrival, flux, weight_here, {flux, vertex.depth, vertex.order}, 0);
}

void LightSplatter::insert_from_vertex(const Vertex& vertex, const PathState& state, const Traveller& traveller) {
  std::optional<SurfaceEvent> event;
  const SurfaceEvent* surface = vertex.is_surface() ? &event.emplace(vertex.surface_event()) : nullptr;
  insert_from(vertex.position, state, traveller, surface, [&](const Vec3& direction) {
    const Vertex::Scattering scattered = vertex.scatter(direction, TransportMode::kImportance);
    return Leaving{vertex.leave(direction), vertex.throughput * scattered.value, scattered.pdf_w};
  });
}

template <class Leave>
void LightSplatter::insert_from(const Vec3& x0, const PathState& state, const Traveller& traveller,
                                const SurfaceEvent* surface, const Leave& leave) {
  const bool inserts = connection_ == CameraConnection::kOnceMore || connection_ == CameraConnection::kMis;
  if (!inserts || !current_phase_ || !may_insert(state)) return;
  Rng rng = sampler_.aside(x0, Vec3(1, 0, 0));
  const Vec2 u_aperture = next_2d(rng), u = next_2d(rng);
  const Vec3 x2 = *scene_.sensor().aperture_point(u_aperture);
  const auto x1 = insert_collision(*current_phase_, x0, x2, insertion_, u.x, u.y, rng.next_float());
  if (!x1) return;
  const Leaving leaving = leave(x1->arrives);
  const auto way = scene_.sensor().connect(x1->position, u_aperture);
  if (leaving.flux.is_black() || !way) return;
  const Vec3 towards = x1->position - leaving.origin;
  const float distance = length(towards);
  if (!(distance > 0)) return;
  const Passage passage = traveller.look_along({leaving.origin, towards / distance, distance}, leaving.flux, surface);
  if (!scatters_as_here(passage)) return;
  Densities d = densities(*current_phase_, x0, x1->position, x2, leaving.pdf_w,
                          passage.medium->proxy_sigma_t(x1->position), passage.proxy);
  d.once_more = x1->pdf_v;
  const double factor = weight(Technique::kOnceMore, d) * inverse_square(x0, x1->position) / x1->pdf_v;
  finish(x1->position, *passage.medium, leaving.flux * passage.transmittance * x1->f, *way, factor, state);
}

/// The walk leaves x0: the edge that begins has another, equiangular, end.
void LightSplatter::depart(const Vec3& x0, float pdf_w, const PathState& state, const Traveller& traveller) {
  last_position_ = x0;
  last_pdf_w_ = pdf_w;
  last_phase_ = current_phase_;
  start_edge();
  const bool marches = connection_ == CameraConnection::kEquiangular || connection_ == CameraConnection::kMis;
  if (!marches || !current_phase_ || !may_insert(state) || state.throughput.is_black()) return;
  Rng rng = sampler_.aside(x0, Vec3(0, 1, 0));
  const Vec2 u_aperture = next_2d(rng);
  const Vec3 x2 = *scene_.sensor().aperture_point(u_aperture);
  const Vec3& direction = traveller.ray().direction;
  const Equiangular equiangular(x0, direction, x2);
  const float t = equiangular.sample(rng.next_float()), pdf_t = equiangular.pdf_t(t);
  if (!(t > 0) || !std::isfinite(t) || !(pdf_t > 0)) return;
  const Vec3 x1 = x0 + direction * t;
  const auto way = scene_.sensor().connect(x1, u_aperture);
  if (!way) return;
  const Passage passage = traveller.look_along({traveller.ray().origin, direction, t}, state.throughput);
  if (!scatters_as_here(passage)) return;
  const float f = current_phase_->eval(dot(direction, normalize(x2 - x1)));
  const Densities d = densities(*current_phase_, x0, x1, x2, pdf_w, passage.medium->proxy_sigma_t(x1), passage.proxy);
  const double factor = weight(Technique::kEquiangular, d) / static_cast<double>(pdf_t);
  finish(x1, *passage.medium, state.throughput * passage.transmittance * f, *way, factor, state);
}

bool LightSplatter::scatters_as_here(const Passage& passage) const {
  return passage.prob > 0 && passage.medium && &passage.medium->phase() == current_phase_;
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
