#include "integrator/virtual_light_gatherer.h"

#include "path/join.h"

namespace turbid {

Spectrum shadowed(const Scatterer& place, const Scatterer& light, const LineSettings& lines,
                  const Traveller& traveller) {
  const Spectrum value = unshadowed(place, light, lines);
  if (value.is_black()) return value;
  const Vertex &here = place.vertex(), &there = light.vertex();
  const Vec3 wi = normalize(light.position() - place.position());
  return value * look_along(traveller, here, line_between(here.leave(wi), there.leave(-wi))).transmittance;
}

void VirtualLightGatherer::ask_virtual_lights(const Vertex& vertex, const Traveller& traveller) {
  if (lights_.empty() || vertex.throughput.is_black()) return;
  const Scatterer place(vertex, TransportMode::kRadiance);
  if (!chooser_) {
    for (const Scatterer& light : lights_.points()) add(place, light, 1, traveller);
    return;
  }
  chooser_->move_to(place);
  Rng rng = sampler_.aside(vertex.position, vertex.given);
  const double samples = plan_.light_samples;
  for (int i = 0; i < plan_.light_samples; ++i) {
    const auto choice = chooser_->sample((i + rng.next_double()) / samples);
    if (choice) add(place, lights_.points()[choice->light], 1 / (choice->prob * samples), traveller);
  }
}

void VirtualLightGatherer::add(const Scatterer& place, const Scatterer& light, double factor,
                               const Traveller& traveller) {
  const int order = place.order() + light.order();
  if (!plan_.path.order_counts(order)) return;
  ++counters_.connections;
  by_order_[std::min(order, kOrderClasses - 1)] +=
      shadowed(place, light, plan_.lines, traveller) * static_cast<float>(factor);
}

}  // namespace turbid
