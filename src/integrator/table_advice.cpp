#include "integrator/table_advice.h"

#include <cmath>

#include "integrator/boundary_images.h"

namespace turbid {

float brightness_without_end(const Scene& scene, const Medium& medium) {
  const HomogeneousMedium* homogeneous = medium.as_homogeneous();
  const auto object = std::find_if(scene.objects().begin(), scene.objects().end(),
                                   [&](const Object& o) { return o.interior.get() == &medium; });
  if (!homogeneous || object == scene.objects().end()) return 1;
  // A place just inside, seen from outside.
  const Bounds3 bounds = object->shape->bounds();
  const Vec3 direction = normalize(Vec3(0.3f, -0.9f, 0.2f));
  const Ray line{bounds.center() - direction * length(bounds.size()), direction};
  float t = kInfinity;
  Ray rest = line;
  for (float passed = 0; const Hit hit = scene.rays().intersect(rest);) {
    passed += hit.t;
    if (&scene.object(hit) == &*object) {
      t = passed;
      break;
    }
    rest.origin = scene.object(hit).shape->surface_point(rest, hit).leave(direction);
  }
  if (!std::isfinite(t)) return 1;
  const Vec3 inside = line.at(t + 1e-3f * length(bounds.size()));
  const BoundaryPlanes planes = Boundaries(scene, {&medium}).around(inside, direction, medium);
  if (planes.empty()) return 1;
  float worst = 1;
  const float g = medium.phase().mean_cosine();
  for (int c = 0; c < kChannels; ++c) {
    const float albedo = homogeneous->albedo()[c];
    if (!(albedo > 0)) continue;
    const float kappa = homogeneous->sigma_t()[c] * std::sqrt(3 * (1 - albedo) * (1 - g * albedo));
    const float x = planes.front().extrapolation * kappa;
    const float ratio = 1 / (1 + 0.9f * (x - 1) / (x + 1));
    if (std::abs(std::log(ratio)) > std::abs(std::log(worst))) worst = ratio;
  }
  return worst;
}

}  // namespace turbid
