#include "photon/default_radii.h"

#include "core/warp.h"
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

/// A place where photons may be merged, and the outside of the surface there, of length 1.
struct SeenSurface {
  Vec3 position, normal;
};

/// What rays through the film meet, straight on through all that merges nothing (smooth or null).
std::vector<SeenSurface> seen_surfaces(const Scene& scene) {
  constexpr int kRays = 1024, kMostPassed = 8;
  // Spread evenly, by powers of the plastic number, at all distances from edges.
  constexpr double kStepX = 0.7548776662466927, kStepY = 0.5698402909980532;
  std::vector<SeenSurface> seen;
  for (int i = 1; i <= kRays; ++i) {
    const double x = i * kStepX, y = i * kStepY;
    const Vec2 film(static_cast<float>(x - std::floor(x)), static_cast<float>(y - std::floor(y)));
    Ray ray = scene.sensor().sample_ray(film, Vec2(0.5f)).ray;
    for (int passed = 0; passed <= kMostPassed; ++passed) {
      const Hit hit = scene.rays().intersect(ray);
      if (!hit) break;
      const SurfacePoint point = scene.object(hit).shape->surface_point(ray, hit);
      if (scene.object(hit).bsdf->flags() & lobe::kSmooth) {
        seen.push_back({point.p, point.ng});
        break;
      }
      ray.origin = point.leave(ray.direction);
    }
  }
  return seen;
}

/// The surface that a vertex at `seen` merges with goes on below or above the point `across` of its tangent plane.
bool goes_on(const Scene& scene, const SeenSurface& seen, const Vec3& across, float radius) {
  constexpr int kMostLayers = 4;
  float height = radius;
  for (int layer = 0; layer < kMostLayers; ++layer) {
    const Vec3 from = seen.position + across + seen.normal * height;
    const Hit hit = scene.rays().intersect({from, -seen.normal, height + radius});
    if (!hit) return false;
    height -= hit.t;
    if (dot(normalize(hit.ng), seen.normal) >= kSameSurface) return length_squared(across) + sqr(height) < sqr(radius);
    height -= 1e-3f * radius;
  }
  return false;
}

/// The share of the disks around what is seen that no surface fills: what merging loses where light is even.
float empty_share(const Scene& scene, const std::vector<SeenSurface>& seen, float radius) {
  constexpr int kStrata = 4;
  size_t empty = 0;
  for (const SeenSurface& place : seen) {
    const Frame frame(place.normal);
    for (int i = 0; i < kStrata * kStrata; ++i) {
      const Vec2 u((static_cast<float>(i % kStrata) + 0.5f) / kStrata,
                   (static_cast<float>(i / kStrata) + 0.5f) / kStrata);
      const Vec2 disk = square_to_disk(u) * radius;
      if (!goes_on(scene, place, frame.s * disk.x + frame.t * disk.y, radius)) ++empty;
    }
  }
  return static_cast<float>(empty) / static_cast<float>(std::max<size_t>(seen.size(), 1) * kStrata * kStrata);
}

float pixel_radius(const Scene& scene, float pixels) {
  const GatherRadius radius = radius_in_pixels(scene, pixels);
  return radius.at_sensor + radius.per_length * viewing_distance(scene);
}

}  // namespace

float default_surface_radius(const Scene& scene, float pixels) {
  constexpr float kMostEmpty = 0.005f, kStep = 0.8f;
  constexpr int kMostSteps = 24;
  const std::vector<SeenSurface> seen = seen_surfaces(scene);
  float radius = pixel_radius(scene, pixels);
  for (int i = 0; i < kMostSteps && empty_share(scene, seen, radius) > kMostEmpty; ++i) radius *= kStep;
  return radius;
}

KernelRadii default_media_radii(const Scene& scene, float pixels) {
  constexpr float kMostOfMeanFreePath = 0.015f;
  const float radius = pixel_radius(scene, pixels);
  KernelRadii result = KernelRadii::in_media(radius);
  result.dense_from = kMostOfMeanFreePath / radius;
  for (const Surroundings& around : scene.media())
    if (around.mean_free_path > 0 && !around.medium->as_homogeneous())
      result.inhomogeneous = std::min(result.inhomogeneous, kMostOfMeanFreePath * around.mean_free_path);
  return result;
}

}  // namespace turbid
