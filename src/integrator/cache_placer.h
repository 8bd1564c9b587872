#pragma once
#include "integrator/virtual_light_gatherer.h"
#include "manylight/importance_cache.h"

namespace turbid {

/// Places the points of an importance cache where walks from the sensor are shaded (S2 sect. 4.1): surfaces and, at
/// random distances along the ways to them, collisions; with ray lights those ways as wholes. Records there what each
/// virtual light brings.
class CachePlacer {
 public:
  CachePlacer(const ShadingPlan& plan, const VirtualLights& lights, uint64_t seed)
      : plan_(plan), lights_(lights), seed_(seed) {}

  /// One point; an ImportanceCache::Recorder. Counts what it does in `counters`.
  ImportanceCache::Record record(PlaceKind kind, size_t number, std::span<float> weights,
                                 SampleCounters& counters) const;

 private:
  class Recorder;
  const ShadingPlan& plan_;
  const VirtualLights& lights_;
  uint64_t seed_;
};

}  // namespace turbid
