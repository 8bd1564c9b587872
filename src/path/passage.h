#pragma once
#include <limits>

#include "core/sampler.h"
#include "path/sample_counters.h"
#include "scene/scene.h"

namespace turbid {

/// What a straight line lets through.
struct Passage {
  Spectrum transmittance{1.0f};  ///< 0 where something opaque or refractive stands in the way
  /// Proxy for the probability that a walk which set out in this direction would have come through without an event.
  /// The walk multiplies its density by the same number, so that multiple importance sampling weighs like with like; it
  /// may be any function of the line as long as both use it.
  float prob = 1;
  /// The product of Medium::proxy_transmittance and Bsdf::null_transmission along the line: the same from either end.
  Spectrum proxy{1.0f};
  const Medium* medium = nullptr;  ///< at the end of the line; null: vacuum
};

/// Probability of passing straight through a surface that transmits `null_transmission`, as used in Passage::prob.
inline float null_prob(const Spectrum& null_transmission) { return null_transmission.mean(); }

/// The weights with which a walk of this throughput mixes the channels' distance densities: in proportion to the
/// throughput, so that a flight never raises the sum over channels by more than the albedo (weights sum to 1). Evenly
/// where hardly anything is left: a walk from the sensor goes on behind what has absorbed all light.
inline Spectrum channel_mix(const Spectrum& throughput) {
  const float sum = throughput.sum();
  return sum > std::numeric_limits<float>::min() ? throughput / sum : Spectrum(1.0f / kChannels);
}

/// Walks along `ray` up to ray.t_max (infinite: to a light at infinity) through null surfaces and media. `throughput`
/// is that of the walk along this direction (any scale): it sets the mixture of the channels; where it is black nothing
/// comes through. `enclosing`: the shapes around the origin, in scenes with priorities only; `medium` is then its
/// medium.
Passage pass_straight(const Scene& scene, Ray ray, const Medium* medium, Spectrum throughput, const Sampler& sampler,
                      SampleCounters& counters, const MediumStack* enclosing = nullptr);

/// From one place to another in the midst of a medium; of no length where they are the same.
inline Ray line_to(const Vec3& origin, const Vec3& end) {
  const Vec3 way = end - origin;
  const float distance = length(way);
  if (!(distance > 0)) return {origin, Vec3(0, 0, 1), 0};
  return {origin, way / distance, distance};
}

/// From one place to just before another; of no length, in any direction, where they are the same.
inline Ray line_between(const Vec3& origin, const Vec3& end) {
  // The end is known to a few units in the last place of the distance.
  constexpr float kBeforeEnd = 1 - 1e-5f;
  Ray line = line_to(origin, end);
  line.t_max *= kBeforeEnd;
  return line;
}

/// From `origin` to just before a light.
inline Ray ray_to_light(const DirectLightSample& light, const Vec3& origin) {
  return std::isfinite(light.distance) ? line_between(origin, light.position) : Ray{origin, light.wi};
}

/// The line is free of any surface; media are ignored.
Passage pass_empty_space(const Scene& scene, const Ray& ray, SampleCounters& counters);

}  // namespace turbid
