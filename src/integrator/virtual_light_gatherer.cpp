#include "integrator/virtual_light_gatherer.h"

namespace turbid {

// --- lines -----------------------------------------------------------------------------------------------------------

Spectrum LightLines::through(const Scatterer& place, const SurfaceEvent* surface, const Scatterer& light,
                             const Spectrum& value, const Traveller& traveller) const {
  const Vec3 wi = normalize(light.position() - place.position());
  const Ray line = line_between(place.leave(wi), light.leave(-wi));
  return value * traveller.look_along(line, Spectrum(1.0f), surface).transmittance;
}

Spectrum LightLines::shadowed(const Scatterer& place, const Scatterer& light, const Traveller& traveller) const {
  const Spectrum value = unshadowed(place, light, settings_);
  if (value.is_black()) return value;
  if (place.medium()) {
    const Vec3 wi = normalize(light.position() - place.position());
    if (!path_.visit_counts(place.medium(), place.visit_order_towards(wi) + light.visit_order_towards(-wi)))
      return Spectrum(0.0f);
  }
  const auto surface = place.is_surface() ? place.vertex().surface_event() : std::nullopt;
  return through(place, surface ? &*surface : nullptr, light, value, traveller);
}

Spectrum LightLines::to_place(const Scatterer& place, size_t light, Rng& rng, const Traveller& traveller) const {
  const size_t points = lights_.points().size();
  if (light < points) return shadowed(place, lights_.points()[light], traveller);
  const CollisionSegment& ray = lights_.rays()[light - points];
  const PlaceOnSegment at = place_towards(ray.way(), place.position(), ray.g(), rng.next_float());
  if (!(at.pdf_t > 0)) return Spectrum(0.0f);
  return shadowed(place, ray.place_at(at.t, at.pdf_t, sampler_), traveller);
}

void LightLines::draw_pairs(const CollisionSegment& way, std::span<const Request> batch,
                            std::array<SegmentPair, kBatch>& pairs) const {
  std::array<PairRequest, kBatch> requests;
  std::array<SegmentPair, kBatch> found;
  const size_t points = lights_.points().size();
  size_t count = 0;
  for (const Request& request : batch)
    if (request.light >= points) {
      const CollisionSegment& ray = lights_.rays()[request.light - points];
      requests[count++] = {&ray.way(), ray.g(), request.u};
    }
  sample_pairs({requests.data(), count}, way.way(), way.g(), {found.data(), count});
  for (size_t i = batch.size(); i-- > 0;)
    if (batch[i].light >= points) pairs[i] = found[--count];
}

Spectrum LightLines::to_way(const CollisionSegment& way, const Request& request, const SegmentPair& pair,
                            const Traveller& traveller) const {
  const size_t points = lights_.points().size();
  if (request.light < points) {
    const Scatterer& point = lights_.points()[request.light];
    const PlaceOnSegment at = place_towards(way.way(), point.position(), way.g(), request.u.x);
    if (!(at.pdf_t > 0)) return Spectrum(0.0f);
    return shadowed(way.place_at(at.t, at.pdf_t, sampler_), point, traveller);
  }
  if (!(pair.pdf > 0)) return Spectrum(0.0f);
  const CollisionSegment& ray = lights_.rays()[request.light - points];
  return shadowed(way.place_at(pair.on_sensor, 1, sampler_), ray.place_at(pair.on_light, pair.pdf, sampler_),
                  traveller);
}

int LightLines::order(size_t light) const {
  const size_t points = lights_.points().size();
  return light < points ? lights_.points()[light].order() : lights_.rays()[light - points].order();
}

// --- the recorder --------------------------------------------------------------------------------------------------

void VirtualLightGatherer::on_passage(const Ray& way, const Medium& medium, const PathState& state,
                                      const Traveller& traveller) {
  make_collisions(way, medium, state, plan_.path.max_depth, plan_.volume_points, sampler_,
                  [&](const CollisionEvent& event, const PathState& at) {
                    if (plan_.rays)
                      ask_lights(event, at, traveller);
                    else
                      shade(event, at, traveller);
                  });
  if (entering_ && std::isfinite(way.t_max)) {
    Rng rng = sampler_.aside(Purpose::kTableAlongWay, way.origin, way.direction);
    add(kOrderClasses, entering_->along(way, medium, state, plan_.table_samples, rng));
  }
  const HomogeneousMedium* homogeneous = medium.as_homogeneous();
  if (!plan_.rays || !(way.t_max > 0) || !std::isfinite(way.t_max) || state.throughput.is_black()) return;
  if (homogeneous && homogeneous->sigma_s().is_black()) return;
  ask_along(CollisionSegment::of_sensor(way, medium, state), traveller);
}

template <class Ask>
void VirtualLightGatherer::choose_lights(int order, bool once, Rng rng, const Ask& ask) {
  const auto choose = [&](size_t light, double factor) {
    Rng own = lights_.rays().empty() ? rng : Rng(hash_counters(rng.next_u32(), rng.next_u32()));
    if (!plan_.path.order_counts(order + lines_.order(light))) return;
    ++counters_.connections;
    ask(light, static_cast<float>(factor), own);
  };
  if (!chooser_) {
    for (size_t light = 0; light < lights_.size(); ++light) choose(light, 1);
    return;
  }
  chooser_->draw(plan_.light_samples, Rng(hash_counters(rng.next_u32(), rng.next_u32())), draws_);
  const double samples = plan_.light_samples;
  constexpr size_t kAhead = 4;  // lights lie anywhere in memory
  for (size_t i = 0; i < draws_.size(); ++i) {
    if (i + kAhead < draws_.size()) lights_.prefetch(draws_[i + kAhead].light);
    const auto& [light, times, prob] = draws_[i];
    if (once && light < lights_.points().size())
      choose(light, times / (prob * samples));
    else
      for (uint32_t k = 0; k < times; ++k) choose(light, 1 / (prob * samples));
  }
}

void VirtualLightGatherer::ask_virtual_lights(const Vertex& vertex, const Traveller& traveller) {
  if (lights_.empty() || vertex.throughput.is_black()) return;
  const Scatterer place(vertex, TransportMode::kRadiance);
  if (chooser_) chooser_->move_to(place);
  // First what lights would bring, then what stands between: so the processor waits for memory once for many.
  waiting_.clear();
  const Rng rng = sampler_.aside(Purpose::kLightsOfPlace, vertex.position, vertex.given);
  choose_lights(place.order(), true, rng, [&](size_t light, float factor, Rng& own) {
    if (light >= lights_.points().size())
      return add(place.order() + lines_.order(light), lines_.to_place(place, light, own, traveller) * factor);
    const Scatterer& point = lights_.points()[light];
    const Spectrum value = unshadowed(place, point, plan_.lines) * factor;
    if (value.is_black()) return;
    if (point.is_surface()) __builtin_prefetch(&point.vertex().point);  // where the line will end
    waiting_.push_back({&point, value});
  });
  cast_lines(place, traveller);
}

void VirtualLightGatherer::cast_lines(const Scatterer& place, const Traveller& traveller) {
  const auto surface = place.is_surface() ? place.vertex().surface_event() : std::nullopt;
  for (const auto& [light, value] : waiting_)
    add(place.order() + light->order(), lines_.through(place, surface ? &*surface : nullptr, *light, value, traveller));
}

void VirtualLightGatherer::ask_along(const CollisionSegment& way, const Traveller& traveller) {
  if (lights_.empty()) return;
  if (chooser_) chooser_->move_along(way.way());
  requests_.clear();
  factors_.clear();
  choose_lights(way.order(), false, sampler_.aside(Purpose::kLightsOfWay, way.way().origin, way.way().direction),
                [&](size_t light, float factor, Rng& rng) {
                  const float u = rng.next_float();
                  requests_.push_back({light, {u, rng.next_float()}});
                  factors_.push_back(factor);
                });
  lines_.to_way(way, requests_, traveller, [&](size_t i, const Spectrum& value) {
    add(way.order() + lines_.order(requests_[i].light), value * factors_[i]);
  });
}

}  // namespace turbid
