#include "path/passage.h"

namespace turbid {
namespace {

constexpr Passage kBlocked{Spectrum(0.0f), 0, Spectrum(0.0f), nullptr};

/// Attenuates along the first `distance` of the ray.
void attenuate(Passage& passage, Spectrum& throughput, const Medium& medium, const Ray& ray, float distance,
               const Sampler& sampler) {
  const Ray part{ray.origin, ray.direction, distance};
  const Spectrum transmittance = medium.transmittance(part, sampler);
  // An estimate of the transmittance is random: weights of multiple importance sampling must not depend on it.
  const Spectrum proxy = medium.as_homogeneous() ? transmittance : medium.proxy_transmittance(part);
  const Spectrum passed = throughput * proxy;
  passage.prob *= passed.sum() / throughput.sum();
  passage.transmittance *= transmittance;
  passage.proxy *= proxy;
  throughput = passed;
}

}  // namespace

Passage pass_empty_space(const Scene& scene, const Ray& ray, SampleCounters& counters) {
  ++counters.shadow_rays;
  return scene.rays().occluded(ray) ? kBlocked : Passage{};
}

Passage pass_straight(const Scene& scene, Ray ray, const Medium* medium, Spectrum throughput, const Sampler& sampler,
                      SampleCounters& counters, const MediumStack* enclosing) {
  if (throughput.is_black()) return kBlocked;
  Passage passage;
  if (!scene.has_null_surfaces()) {
    passage = pass_empty_space(scene, ray, counters);
    if (medium && passage.prob > 0) {
      const float distance = std::isfinite(ray.t_max) ? ray.t_max : scene.distance_to_world_end(ray);
      attenuate(passage, throughput, *medium, ray, distance, sampler);
    }
    passage.medium = medium;
    return passage;
  }
  MediumStack media;
  if (enclosing) media = *enclosing;
  while (true) {
    ++counters.shadow_rays;
    const Hit hit = scene.rays().intersect(ray);
    if (medium) {
      const float distance = hit ? hit.t : std::isfinite(ray.t_max) ? ray.t_max : scene.distance_to_world_end(ray);
      attenuate(passage, throughput, *medium, ray, distance, sampler);
      if (passage.prob == 0 || passage.transmittance.is_black()) return kBlocked;
    }
    passage.medium = medium;
    if (!hit) return passage;

    const Object& object = scene.object(hit);
    const bool hidden = enclosing && media.hides(object);
    if (!hidden && !(object.bsdf->flags() & lobe::kNull)) return kBlocked;
    const SurfacePoint point = object.shape->surface_point(ray, hit);
    if (!hidden) {
      const Spectrum through = object.bsdf->null_transmission(point, point.to_local(-ray.direction));
      if (through.is_black()) return kBlocked;
      passage.transmittance *= through;
      passage.prob *= null_prob(through);
      passage.proxy *= through;
      throughput *= through;
      if (throughput.is_black()) return kBlocked;
    }
    if (enclosing) {
      media.cross(object, point.ng, -ray.direction, ray.direction);
      medium = media.medium();
    } else if (object.bounds_media)
      medium = object.medium_towards(point.ng, ray.direction);
    ray.origin = point.leave(ray.direction);
    ray.t_max -= hit.t;
  }
}

}  // namespace turbid
