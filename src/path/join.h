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

/// StrategyWeights::merges_at for a collision in the medium that deflects by `mu`.
inline Merges merges_at(const StrategyWeights& weights, const Medium& medium, float mu) {
  if (!weights.merges_in_media()) return {};
  const HomogeneousMedium* homogeneous = medium.as_homogeneous();
  if (!homogeneous) return weights.merges_at(0, mu);
  const Spectrum& sigma_t = homogeneous->sigma_t();
  return weights.merges_at(static_cast<double>(sigma_t.mean()), mu,
                           weights.kernel_scale(static_cast<double>(sigma_t.max())));
}

/// Sum of the powers of all merges at a vertex that is left in the direction `chosen` (unit).
inline double merged_at(const StrategyWeights& weights, const Vertex& vertex, const Vec3& chosen) {
  if (vertex.is_surface()) return weights.merged_at_surface();
  return merges_at(weights, *vertex.medium, -dot(vertex.given, chosen)).sum();
}

/// 1/distance^2. (Two collisions may round to the same place.)
inline double inverse_square(const Vec3& a, const Vec3& b) {
  constexpr float kLeast = 1e-30f;
  return 1 / static_cast<double>(std::max(length_squared(a - b), kLeast));
}

}  // namespace turbid
