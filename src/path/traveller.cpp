#include "path/traveller.h"

namespace turbid {

Passage Traveller::look_along(const Ray& line, const Spectrum& throughput, const SurfaceEvent* surface) const {
  if (!sees_media_) return pass_empty_space(scene_, line, counters_);
  if (stacked_) {
    MediumStack media = media_;
    if (surface) media.cross(surface->object, surface->point.ng, -ray_.direction, line.direction);
    return pass_straight(scene_, line, media.medium(), throughput, sampler_, counters_, &media);
  }
  const bool bounds = surface && surface->object.bounds_media;
  const Medium* medium = bounds ? surface->object.medium_towards(surface->point.ng, line.direction) : medium_;
  return pass_straight(scene_, line, medium, throughput, sampler_, counters_);
}

}  // namespace turbid
