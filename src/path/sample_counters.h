#pragma once
#include <cstdint>

namespace turbid {

/// Counts of one task of one pass; added to the integrator's totals when the task is done.
struct SampleCounters {
  uint64_t camera_samples = 0;
  uint64_t light_paths = 0;
  uint64_t rays = 0;                  ///< nearest-hit casts
  uint64_t shadow_rays = 0;           ///< casts towards lights or the sensor, one for each surface passed
  uint64_t connections = 0;           ///< of vertices of light and sensor paths
  uint64_t collisions = 0;            ///< in media
  uint64_t free_flights = 0;          ///< collisions that needed no cast, inside a ball known to be empty
  uint64_t refractive_paths = 0;      ///< found through interfaces, before anything in their way is asked for
  uint64_t unresolved_triangles = 0;  ///< whose refraction the solver gave up on, in part
  uint64_t dropped_samples = 0;       ///< not finite or negative

  void add(const SampleCounters& other) {
    camera_samples += other.camera_samples;
    light_paths += other.light_paths;
    rays += other.rays;
    shadow_rays += other.shadow_rays;
    connections += other.connections;
    collisions += other.collisions;
    free_flights += other.free_flights;
    refractive_paths += other.refractive_paths;
    unresolved_triangles += other.unresolved_triangles;
    dropped_samples += other.dropped_samples;
  }
};

}  // namespace turbid
