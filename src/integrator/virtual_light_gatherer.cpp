#include "integrator/virtual_light_gatherer.h"

#include "path/join.h"

namespace turbid {

// --- lines -----------------------------------------------------------------------------------------------------------

Spectrum LightLines::shadowed(const Scatterer& place, const Scatterer& light, const Traveller& traveller) const {
  const Spectrum value = unshadowed(place, light, settings_);
  if (value.is_black()) return value;
  const Vertex &here = place.vertex(), &there = light.vertex();
  const Vec3 wi = normalize(light.position() - place.position());
  return value * look_along(traveller, here, line_between(here.leave(wi), there.leave(-wi))).transmittance;
}

Spectrum LightLines::to_place(const Scatterer& place, size_t light, Rng& rng, const Traveller& traveller) const {
  const size_t points = lights_.points().size();
  if (light < points) return shadowed(place, lights_.points()[light], traveller);
  const CollisionSegment& ray = lights_.rays()[light - points];
  const PlaceOnSegment at = place_towards(ray.way(), place.position(), ray.g(), rng.next_float());
  if (!(at.pdf_t > 0)) return Spectrum(0.0f);
  const Vertex vertex = ray.place_at(at.t, at.pdf_t, sampler_);
  return shadowed(place, Scatterer(vertex, TransportMode::kImportance), traveller);
}

Spectrum LightLines::to_way(const CollisionSegment& way, size_t light, Rng& rng, const Traveller& traveller) const {
  const size_t points = lights_.points().size();
  if (light < points) {
    const Scatterer& point = lights_.points()[light];
    const PlaceOnSegment at = place_towards(way.way(), point.position(), way.g(), rng.next_float());
    if (!(at.pdf_t > 0)) return Spectrum(0.0f);
    const Vertex vertex = way.place_at(at.t, at.pdf_t, sampler_);
    return shadowed(Scatterer(vertex, TransportMode::kRadiance), point, traveller);
  }
  const CollisionSegment& ray = lights_.rays()[light - points];
  const float u = rng.next_float();
  const SegmentPair pair = sample_pair(ray.way(), way.way(), {ray.g(), way.g()}, {u, rng.next_float()});
  if (!(pair.pdf > 0)) return Spectrum(0.0f);
  const Vertex here = way.place_at(pair.on_sensor, 1, sampler_),
               there = ray.place_at(pair.on_light, pair.pdf, sampler_);
  return shadowed(Scatterer(here, TransportMode::kRadiance), Scatterer(there, TransportMode::kImportance), traveller);
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
                      direct_->at_collision(event, at, traveller);
                    else
                      shade(event, at, traveller);
                  });
  const HomogeneousMedium* homogeneous = medium.as_homogeneous();
  if (!plan_.rays || !(way.t_max > 0) || !std::isfinite(way.t_max) || state.throughput.is_black()) return;
  if (homogeneous && homogeneous->sigma_s().is_black()) return;
  ask_along(CollisionSegment::of_sensor(way, medium, state), traveller);
}

template <class Bring>
void VirtualLightGatherer::ask(int order, Rng rng, const Bring& bring) {
  const auto add = [&](size_t light, double factor) {
    const int of_path = order + lines_.order(light);
    const bool counts = plan_.path.order_counts(of_path);
    // Numbers of its own, so that whether it counts changes nothing else.
    Rng own = lights_.rays().empty() ? rng : Rng(hash_counters(rng.next_u32(), rng.next_u32()));
    if (!counts) return;
    ++counters_.connections;
    by_order_[std::min(of_path, kOrderClasses - 1)] += bring(light, own) * static_cast<float>(factor);
  };
  if (!chooser_) {
    for (size_t light = 0; light < lights_.size(); ++light) add(light, 1);
    return;
  }
  const double samples = plan_.light_samples;
  for (int i = 0; i < plan_.light_samples; ++i) {
    const auto choice = chooser_->sample((i + rng.next_double()) / samples);
    if (choice) add(choice->light, 1 / (choice->prob * samples));
  }
}

void VirtualLightGatherer::ask_virtual_lights(const Vertex& vertex, const Traveller& traveller) {
  if (lights_.empty() || vertex.throughput.is_black()) return;
  const Scatterer place(vertex, TransportMode::kRadiance);
  if (chooser_) chooser_->move_to(place);
  ask(place.order(), sampler_.aside(vertex.position, vertex.given),
      [&](size_t light, Rng& rng) { return lines_.to_place(place, light, rng, traveller); });
}

void VirtualLightGatherer::ask_along(const CollisionSegment& way, const Traveller& traveller) {
  if (lights_.empty()) return;
  if (chooser_) chooser_->move_along(way.way());
  ask(way.order(), sampler_.aside(way.way().origin, way.way().direction),
      [&](size_t light, Rng& rng) { return lines_.to_way(way, light, rng, traveller); });
}

}  // namespace turbid
