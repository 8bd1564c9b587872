#pragma once
#include "core/sampler.h"
#include "scene/scene.h"

namespace turbid {

/// Begins sample `index` of a pixel, given by its place on the whole film (so that a crop shows the same samples as the
/// full image), and draws its ray: the position in the pixel from the reconstruction filter's density, then the point
/// on the aperture where there is one.
inline SensorRay start_camera_sample(const Scene& scene, const Vec2i& on_film, uint64_t index, Sampler& sampler) {
  const FilmSettings& film = scene.film();
  sampler.start(static_cast<uint64_t>(on_film.y) << 32 | static_cast<uint64_t>(on_film.x), index);
  const Vec2 center{static_cast<float>(on_film.x) + 0.5f, static_cast<float>(on_film.y) + 0.5f};
  const Vec2 scale{1 / static_cast<float>(film.size.x), 1 / static_cast<float>(film.size.y)};
  const Vec2 position = (center + film.filter.sample(sampler.next_2d())) * scale;
  const Vec2 u_aperture = scene.sensor().needs_aperture() ? sampler.next_2d() : Vec2(0.5f);
  SensorRay ray = scene.sensor().sample_ray(position, u_aperture);
  ray.u_aperture = u_aperture;
  return ray;
}

}  // namespace turbid
