#include "manylight/collision_segment.h"

namespace turbid {

CollisionSegment CollisionSegment::of_sensor(const Ray& way, const Medium& medium, const PathState& state) {
  CollisionSegment segment;
  segment.way_ = way;
  segment.medium_ = &medium;
  segment.throughput_ = state.throughput;
  segment.homogeneous_ = medium.as_homogeneous();
  if (segment.homogeneous_) segment.scattered_ = state.throughput * segment.homogeneous_->sigma_s();
  segment.g_ = medium.phase().mean_cosine();
  segment.depth_ = state.depth + 1;
  segment.order_ = state.order + 1;
  segment.visit_order_ = state.visit_order + 1;
  return segment;
}

CollisionSegment CollisionSegment::of_light(const Ray& way, const HomogeneousMedium& medium, const PathState& state,
                                            float scale) {
  CollisionSegment segment = of_sensor(way, medium, state);
  segment.throughput_ *= scale;
  segment.scattered_ *= scale;
  segment.mix_ = channel_mix(state.throughput);
  segment.from_light_ = true;
  return segment;
}

Spectrum CollisionSegment::scattered_at(const Vec3& p, float t, const Sampler& sampler) const {
  return throughput_ * medium_->transmittance({way_.origin, way_.direction, t}, sampler) * medium_->sigma_s_at(p);
}

}  // namespace turbid
