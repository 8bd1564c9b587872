#include "path/traveller.h"

namespace turbid {

Passage Traveller::look_along(const Ray& line, const Spectrum& throughput, const Object* object,
                              const SurfacePoint* point) const {
  if (!sees_media_) return pass_empty_space(scene_, line, counters_);
  if (stacked_) {
    MediumStack media = media_;
    if (object) media.cross(*object, point->ng, -ray_.direction, line.direction);
    return pass_straight(scene_, line, media.medium(), throughput, sampler_, counters_, &media);
  }
  const bool bounds = object && object->bounds_media;
  const Medium* medium = bounds ? object->medium_towards(point->ng, line.direction) : medium_;
  return pass_straight(scene_, line, medium, throughput, sampler_, counters_);
}

}  // namespace turbid
