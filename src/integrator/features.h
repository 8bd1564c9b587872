#pragma once
#include "integrator/sampling_integrator.h"

namespace turbid {

/// What a sensor ray comes to first: a surface that scatters light into many directions, or a collision in a medium.
/// Smooth glass, mirrors and null surfaces are passed. Everything is 0 when nothing is met.
struct Features {
  /// Throughput up to there x the albedo of what is met: for surfaces about the reflectance, for media the scattering
  /// albedo. Its mean over samples is what the picture would be if all that scatters glowed with its albedo.
  Spectrum albedo{0.0f};
  float depth = 0;                                          ///< length of the way from the sensor
  Vec3 position{0, 0, 0};                                   ///< world space
  Vec3 geometric_normal{0, 0, 0}, shading_normal{0, 0, 0};  ///< unit, on the outside; 0 in media
  Vec2 uv{0, 0};
  Vec3 dp_du{0, 0, 0}, dp_dv{0, 0, 0};
  uint32_t primitive = 0, shape = 0;  ///< indices from 0, of surfaces
};

/// Follows a sensor ray to its features. `media`: collisions count, else media are ignored.
Features find_features(const Scene& scene, const SensorRay& camera, bool media, Sampler& sampler);

}  // namespace turbid
