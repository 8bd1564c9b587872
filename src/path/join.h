#pragma once
#include "path/traveller.h"
#include "path/vertex.h"

namespace turbid {

/// What a line between a vertex of a walk from the sensor and one of a walk from a light brings.
struct Joined {
  Spectrum value;     ///< both throughputs, both scatterings, what the line lets through, 1/distance^2
  double others = 0;  ///< StrategyWeights: sum of (p_j / p)^b over all other strategies of the path
};

/// Joins two vertices; `traveller` is that of the walk from the sensor and stands at its vertex. Empty where no light
/// gets from the one to the other. Both vertices know their StrategySums.
std::optional<Joined> join(const Scene& scene, const StrategyWeights& weights, const Vertex& from_sensor,
                           const Vertex& from_light, const Traveller& traveller);

/// Traveller::look_along from a vertex.
inline Passage look_along(const Traveller& traveller, const Vertex& vertex, const Ray& line,
                          const Spectrum& throughput = Spectrum(1.0f)) {
  const auto surface = vertex.surface_event();
  return traveller.look_along(line, throughput, surface ? &*surface : nullptr);
}

/// 1/distance^2. (Two collisions may round to the same place.)
inline double inverse_square(const Vec3& a, const Vec3& b) {
  constexpr float kLeast = 1e-30f;
  return 1 / static_cast<double>(std::max(length_squared(a - b), kLeast));
}

}  // namespace turbid
