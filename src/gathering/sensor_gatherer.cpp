#include "gathering/sensor_gatherer.h"

namespace turbid {
namespace {

/// A channel of the ones that a flight was drawn from, given what became of it: with S5 sect. 3.3 a channel is picked
/// in proportion to the throughput, then steps are of that channel until the flight ends.
int pick_channel(const Spectrum& shares, float u) {
  float rest = u * shares.sum();
  int picked = kChannels - 1;
  for (int c = 0; c < kChannels; ++c) {
    if (shares[c] <= 0) continue;
    picked = c;
    if (rest < shares[c]) break;
    rest -= shares[c];
  }
  return picked;
}

}  // namespace

GatherRadius radius_in_pixels(const Scene& scene, float pixels) {
  const Vec2 size{static_cast<float>(scene.film().size.x), static_cast<float>(scene.film().size.y)};
  const SensorRay a = scene.sensor().sample_ray({0.5f, 0.5f}, {0.5f, 0.5f});
  const SensorRay b = scene.sensor().sample_ray({0.5f + 1 / size.x, 0.5f}, {0.5f, 0.5f});
  // The noise of volumes goes with 1/radius^2, and its integral along a line of sight is nearly all from where it
  // begins. What is nearer than this share of the scene is drawn less sharply.
  constexpr float kLeastLength = 0.5f;
  return {pixels * length(b.ray.origin - a.ray.origin), pixels * length(b.ray.direction - a.ray.direction),
          kLeastLength * scene.radius()};
}

float length_to_surface(const Scene& scene, const Ray& way, const Medium& medium, SampleCounters& counters) {
  const float end = scene.surroundings(&medium).bounded ? kInfinity : scene.distance_to_world_end(way);
  ++counters.rays;
  const Hit hit = scene.rays().intersect({way.origin, way.direction, end});
  const float length = hit ? hit.t : end;
  // A closed boundary that the ray slips through has no next surface.
  return std::isfinite(length) ? std::max(length, way.t_max) : way.t_max;
}

// --- volumes in media ---------------------------------------------------------------------------------------------

void SensorGatherer::on_segment(const Ray& way, const Medium& medium, const PathState& state,
                                const Traveller::Leg& leg) {
  if (beyond_rough_ || state.order >= plan_.gather.collisions) return;
  if (state.depth + 2 > plan_.path.max_depth || state.order + 1 > plan_.path.max_scattering) return;
  const HomogeneousMedium* homogeneous = medium.as_homogeneous();
  if (!homogeneous) return place_flights(way, medium, state, leg);
  if (homogeneous->sigma_s().is_black()) return;
  if (plan_.gather.volumes == GatherSettings::Volumes::kCylinders) return place_cylinder(way, *homogeneous, state);
  place_spheres(way, *homogeneous, state, leg.collides);
}

/// The real collision is the walk's own. Null collisions are a Poisson process beside it: tentative ones of density
/// sigma/q of which each is real with probability q are the same as two independent processes, sigma and sigma (1-q)/q.
/// All spheres together have density p(t)/q, where p is the mixture of the channels' densities that the flight was
/// drawn from, hence the weight q T/p.
void SensorGatherer::place_spheres(const Ray& way, const HomogeneousMedium& medium, const PathState& state,
                                   bool collides) {
  const Spectrum mix = channel_mix(state.throughput), sigma = medium.sigma_t();
  const float q = plan_.gather.q;
  const auto place_at = [&](float t) {
    const Spectrum passed = medium.transmittance(t);
    GatherVolume sphere{.origin = way.at(t), .direction = way.direction};
    sphere.weight = state.throughput * passed * (q / (mix * sigma * passed).sum());
    place(sphere, medium, state, t);
  };
  if (collides) place_at(way.t_max);
  if (q >= 1) return;
  Rng rng = sampler_.aside(Purpose::kIntegrationSpheres, way.origin, way.direction);
  Spectrum shares = mix * medium.transmittance(way.t_max);
  if (collides) shares *= sigma;
  const float sigma_picked = sigma[pick_channel(shares, rng.next_float())];
  if (!(sigma_picked > 0)) return;
  const float step = q / ((1 - q) * sigma_picked);
  for (float t = 0;;) {
    t -= std::log(1 - rng.next_float()) * step;
    if (!(t < way.t_max)) return;
    place_at(t);
  }
}

/// Around pieces of the flight, each with the radius of its middle.
void SensorGatherer::place_cylinder(const Ray& way, const HomogeneousMedium& medium, const PathState& state) {
  constexpr int kPieces = 16;
  const float whole = plan_.gather.long_cylinders ? length_to_surface(plan_.scene, way, medium, counters_) : way.t_max;
  if (!(whole > 0)) return;
  for (int i = 0; i < kPieces; ++i) {
    const float start = whole * static_cast<float>(i) / kPieces, end = whole * static_cast<float>(i + 1) / kPieces;
    GatherVolume piece{.origin = way.at(start), .direction = way.direction, .length = end - start, .start = start};
    piece.weight = state.throughput;
    if (piece.length > 0) place(piece, medium, state, (start + end) / 2);
  }
}

/// Media without closed forms: spheres at real collisions, those of the walk and of further flights on the same way.
void SensorGatherer::place_flights(const Ray& way, const Medium& medium, const PathState& state,
                                   const Traveller::Leg& leg) {
  const int flights = static_cast<int>(std::lround(1 / plan_.gather.q));
  const auto place_at = [&](float t, const Spectrum& weight) {
    GatherVolume sphere{.origin = way.at(t), .direction = way.direction};
    const Spectrum sigma_s = medium.sigma_s_at(sphere.origin);
    for (int c = 0; c < kChannels; ++c)
      sphere.weight[c] =
          sigma_s[c] > 0 ? state.throughput[c] * weight[c] / (sigma_s[c] * static_cast<float>(flights)) : 0;
    place(sphere, medium, state, t);
  };
  if (leg.collides) place_at(way.t_max, leg.weight);
  if (flights == 1) return;
  const Ray whole{way.origin, way.direction,
                  leg.collides ? length_to_surface(plan_.scene, way, medium, counters_) : way.t_max};
  for (int i = 1; i < flights; ++i) {
    const Flight flight = medium.sample_flight(whole, channel_mix(state.throughput), sampler_);
    if (flight.collides) place_at(flight.t, flight.weight);
  }
}

void SensorGatherer::place(GatherVolume volume, const Medium& medium, const PathState& state, float distance) {
  volume.radius = plan_.volume_radius.at(walked_ + length(volume.origin - last_event_) +
                                         (volume.is_sphere() ? 0 : distance - volume.start));
  volume.medium = &medium;
  volume.pixel = pixel_;
  volume.depth = state.depth + 1;
  volume.order = state.order + 1;
  volume.last = volume.order == plan_.gather.collisions;
  result_->volumes.push_back(volume);
}

// --- light at surfaces, and light that the walk meets --------------------------------------------------------------

void SensorGatherer::at_surface(const SurfaceEvent& event, const PathState& state, const Traveller& traveller) {
  arrive(event.point.p);
  if (!(event.object.bsdf->flags() & lobe::kSmooth)) return;
  const Vertex vertex(event, state, traveller.medium());
  ask_for_light(vertex, traveller);
  if (plan_.gather.disks) result_->disks.push_back({vertex, plan_.disk_radius.at(walked_), pixel_});
}

void SensorGatherer::at_collision(const CollisionEvent& event, const PathState& state, const Traveller& traveller) {
  if (beyond_rough_ && !traveller.blind()) ask_for_light(Vertex(event, state), traveller);
}

void SensorGatherer::left_surface(const SurfaceEvent& event, const BsdfSample& sample, const Vec3&, const PathState&,
                                  const Traveller&) {
  arrive(event.point.p);
  by_chance_ = sample.flags & lobe::kDelta;
  if (by_chance_) return;
  beyond_rough_ = scattered_ = true;
  ended_ = plan_.gather.disks;
}

void SensorGatherer::left_collision(const CollisionEvent& event, float, const Vec3&, const PathState& state,
                                    const Traveller&) {
  arrive(event.position);
  by_chance_ = false;
  scattered_ = true;
  const bool only_surfaces = !beyond_rough_ && state.order >= plan_.gather.collisions;
  if (only_surfaces) ended_ = plan_.gather.surface_light_in_volumes || !plan_.has_rough_surfaces;
}

/// In front of z the volumes take the light of paths that collide; behind z lights are asked for where they can be.
bool SensorGatherer::chance_counts(const PathState& state) const {
  if (state.depth == 1 && plan_.path.hide_emitters) return false;
  return beyond_rough_ ? by_chance_ : !scattered_;
}

void SensorGatherer::at_light(const Hit&, const Object& object, const SurfacePoint& point, const PathState& state,
                              const Traveller& traveller) {
  if (chance_counts(state))
    find(state.throughput * object.emitter->Le(point, -traveller.ray().direction), 0, state.depth + 1, state.order);
}

void SensorGatherer::at_escape(const PathState& state, const Traveller& traveller) {
  if (!chance_counts(state)) return;
  for (const ChosenEnvironment& environment : plan_.scene.environments())
    find(state.throughput * environment.emitter->Le(traveller.ray().direction), 0, state.depth + 1, state.order);
}

/// Next-event estimation by itself: the only way to light that comes to a rough surface straight from a light that can
/// be aimed at.
void SensorGatherer::ask_for_light(const Vertex& vertex, const Traveller& traveller) {
  float u_light = sampler_.next_1d();
  const Vec2 u = sampler_.next_2d();
  const EmitterChoice choice = plan_.scene.choose_emitter(u_light);
  if (!choice.emitter || !plan_.path.order_counts(vertex.order)) return;
  const auto light = choice.emitter->sample_direct(vertex.position, u);
  if (!light) return;
  const Vec3 wi = light->wi;
  const Spectrum towards = vertex.throughput * vertex.scatter(wi, TransportMode::kRadiance).value;
  if (towards.is_black()) return;
  const auto event = vertex.surface_event();
  const SurfaceEvent* surface = event ? &*event : nullptr;
  const Passage passage = traveller.look_along(ray_to_light(*light, vertex.leave(wi)), towards, surface);
  if (passage.prob == 0) return;
  find(towards * passage.transmittance * light->weight / choice.prob, 1, vertex.depth + 1, vertex.order);
}

void SensorGatherer::find(const Spectrum& value, int light_vertices, int sensor_vertices, int order) {
  if (!plan_.path.order_counts(order)) return;
  result_->light.push_back({pixel_, {value, 1, light_vertices, sensor_vertices, order}});
}

}  // namespace turbid
