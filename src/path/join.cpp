#include "path/join.h"

namespace turbid {

std::optional<Joined> join(const Scene& scene, const StrategyWeights& weights, const Vertex& from_sensor,
                           const Vertex& from_light, const Traveller& traveller) {
  if (from_light.position == from_sensor.position) return std::nullopt;
  const double inverse = inverse_square(from_light.position, from_sensor.position);
  const Vec3 wi = (from_light.position - from_sensor.position) * static_cast<float>(std::sqrt(inverse));
  if (scene.separates(from_sensor.medium_towards(wi), from_light.medium_towards(-wi))) return std::nullopt;
  const Vertex::Scattering here = from_sensor.scatter(wi, TransportMode::kRadiance);
  if (here.value.is_black()) return std::nullopt;
  const Vertex::Scattering there = from_light.scatter(-wi, TransportMode::kImportance);
  if (there.value.is_black()) return std::nullopt;
  const Passage passage =
      look_along(traveller, from_sensor, line_between(from_sensor.leave(wi), from_light.leave(-wi)));
  if (passage.prob == 0) return std::nullopt;

  const double light_made_by_sensor =
      static_cast<double>(here.pdf_w) * end_factor(from_light, wi, passage.proxy) * inverse;
  const double sensor_made_by_light =
      static_cast<double>(there.pdf_w) * end_factor(from_sensor, wi, passage.proxy) * inverse;
  return Joined{from_sensor.throughput * here.value * passage.transmittance * there.value * from_light.throughput *
                    static_cast<float>(inverse),
                weights.others(from_light.sums, light_made_by_sensor, static_cast<double>(there.pdf_back_w),
                               merged_at(weights, from_light, -wi)) +
                    weights.others(from_sensor.sums, sensor_made_by_light, static_cast<double>(here.pdf_back_w),
                                   merged_at(weights, from_sensor, wi))};
}

}  // namespace turbid
