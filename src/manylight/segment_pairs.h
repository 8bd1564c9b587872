#pragma once
#include <span>

#include "manylight/segment_pair.h"

namespace turbid {

/// A light's segment that a place is asked for, as sample_pair takes it.
struct PairRequest {
  const Ray* light;
  float g_light;
  Vec2 u;
};

/// sample_pair for many lights and one segment of the sensor, a pair in each lane of the processor's vectors. Densities
/// are those of sample_pair but for rounding; where only some of the pairs have lobes, all are weighed.
void sample_pairs(std::span<const PairRequest> requests, const Ray& sensor, float g_sensor,
                  std::span<SegmentPair> result);

}  // namespace turbid
