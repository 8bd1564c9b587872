#include "photon/default_radii.h"

#include "gathering/sensor_gatherer.h"

namespace turbid {
namespace {

/// Median of the distances at which rays through a grid of the film meet something.
float viewing_distance(const Scene& scene) {
  constexpr int kGrid = 24;
  std::vector<float> distances;
  for (int y = 0; y < kGrid; ++y)
    for (int x = 0; x < kGrid; ++x) {
      const Vec2 film((static_cast<float>(x) + 0.5f) / kGrid, (static_cast<float>(y) + 0.5f) / kGrid);
      const SensorRay camera = scene.sensor().sample_ray(film, Vec2(0.5f));
      if (const Hit hit = scene.rays().intersect(camera.ray)) distances.push_back(hit.t);
    }
  if (distances.empty()) return length(scene.center() - scene.sensor().position()) + scene.radius();
  const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
  std::nth_element(distances.begin(), middle, distances.end());
  return *middle;
}

}  // namespace

float default_surface_radius(const Scene& scene, float pixels) {
  const GatherRadius radius = radius_in_pixels(scene, pixels);
  return radius.at_sensor + radius.per_length * viewing_distance(scene);
}

float default_media_radius(const Scene& scene, float pixels) {
  constexpr float kMostOfMeanFreePath = 0.015f;
  float radius = default_surface_radius(scene, pixels);
  for (const Surroundings& around : scene.media())
    if (around.mean_free_path > 0) radius = std::min(radius, kMostOfMeanFreePath * around.mean_free_path);
  return radius;
}

}  // namespace turbid
