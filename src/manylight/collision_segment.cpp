#include "manylight/collision_segment.h"

#include "medium/homogeneous.h"

namespace turbid {

CollisionSegment CollisionSegment::of_sensor(const Ray& way, const Medium& medium, const PathState& state) {
  CollisionSegment segment;
  segment.way_ = way;
  segment.medium_ = &medium;
  segment.throughput_ = state.throughput;
  segment.g_ = medium.phase().mean_cosine();
  segment.depth_ = state.depth + 1;
  segment.order_ = state.order + 1;
  segment.visit_order_ = state.visit_order + 1;
  return segment;
}

CollisionSegment CollisionSegment::of_light(const Ray& way, const HomogeneousMedium& medium, const PathState& state,
                                            float scale) {
  CollisionSegment segment = of_sensor(way, medium, state);
  segment.throughput_ = state.throughput * scale;
  segment.mix_ = channel_mix(state.throughput);
  segment.from_light_ = true;
  return segment;
}

Scatterer CollisionSegment::place_at(float t, double pdf_t, const Sampler& sampler) const {
  const CollisionEvent event{way_.at(t), way_.direction, *medium_};
  Spectrum arrives = medium_->transmittance({way_.origin, way_.direction, t}, sampler);
  if (from_light_) {
    const float survives = (mix_ * arrives).sum();
    arrives = survives > 0 ? arrives / survives : Spectrum(0.0f);
  }
  return Scatterer(
      event, PathState{throughput_ * arrives * medium_->sigma_s_at(event.position) * static_cast<float>(1 / pdf_t),
                       depth_, order_, visit_order_});
}

}  // namespace turbid
