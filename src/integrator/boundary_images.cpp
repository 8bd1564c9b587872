#include "integrator/boundary_images.h"

#include <cmath>

#include "core/frame.h"
#include "path/events.h"

namespace turbid {
namespace {

/// A of 2 A D by the moments r1 = 2 int R c dc and r2 = 3 int R c^2 dc of the reflectance R for light from one side,
/// c = |cos|.
float reflection_factor(const Bsdf& bsdf, float side) {
  if (!keeps_visit(bsdf)) return 1;  // what it reflects, if anything, is another visit's
  constexpr int kCosines = 64, kLobes = 16;
  const SurfacePoint point{};
  float r1 = 0, r2 = 0;
  for (int i = 0; i < kCosines; ++i) {
    const float c = (static_cast<float>(i) + 0.5f) / kCosines;
    float reflected = 0;
    for (int j = 0; j < kLobes; ++j) {
      const float u = (static_cast<float>(j) + 0.5f) / kLobes;
      const auto sample = bsdf.sample(point, {safe_sqrt(1 - c * c), 0, side * c}, u, {std::fmod(u * 7, 1.0f), u},
                                      TransportMode::kRadiance);
      if (sample && sample->flags & lobe::kReflection) reflected += sample->weight.mean() / kLobes;
    }
    r1 += 2 * c * reflected / kCosines;
    r2 += 3 * c * c * reflected / kCosines;
  }
  return (1 + r2) / std::max(1 - r1, 1e-3f);
}

}  // namespace

void add_boundary(const BoundaryPlane& plane, BoundaryPlanes& planes) {
  constexpr float kLeastShare = 0.05f;
  float share = plane.share;
  for (const BoundaryPlane& other : planes) share *= 1 - std::max(0.0f, dot(other.normal, plane.normal));
  if (share < kLeastShare) return;
  planes.push_back(plane);
  planes.back().share = share;
}

Boundaries::Boundaries(const Scene& scene, const std::vector<const Medium*>& media) : scene_(scene) {
  const auto is_one = [&](const std::shared_ptr<const Medium>& medium) {
    return std::find(media.begin(), media.end(), medium.get()) != media.end();
  };
  for (const Object& object : scene.objects()) {
    factors_.push_back(is_one(object.interior) ? reflection_factor(*object.bsdf, -1) : 1);
    outer_factors_.push_back(is_one(object.exterior) ? reflection_factor(*object.bsdf, 1) : 1);
  }
}

std::optional<BoundaryPlane> Boundaries::towards(const Ray& line, const Medium& medium) const {
  const Hit hit = scene_.rays().intersect(line);
  if (!hit) return std::nullopt;
  const SurfacePoint point = scene_.object(hit).shape->surface_point(line, hit);
  const bool inside = leads_outside(point.ng, line.direction);
  const float g = medium.phase().mean_cosine();
  const float diffusion = 1 / (3 * (medium.sigma_t().mean() - g * medium.sigma_s().mean()));
  return BoundaryPlane{point.p, inside ? point.ng : -point.ng,
                       2 * (inside ? factors_ : outer_factors_)[hit.shape] * diffusion};
}

BoundaryPlanes Boundaries::around(const Vec3& x, const Vec3& direction, const Medium& medium) const {
  BoundaryPlanes planes;
  const auto behind = towards({x, -direction}, medium);
  if (!behind) return planes;
  planes.push_back(*behind);
  // Beyond this little light comes back: some times the depth from which light that is not absorbed comes out.
  constexpr float kFar = 12;
  const float reduced = medium.sigma_t().mean() - medium.phase().mean_cosine() * medium.sigma_s().mean();
  const Frame beside(behind->normal);
  for (const Vec3& way : {direction, beside.s, -beside.s, beside.t, -beside.t}) {
    if (const auto plane = towards({x, way, kFar / reduced}, medium)) add_boundary(*plane, planes);
  }
  return planes;
}

std::array<WeightedStretch, 4> with_images(const Stretch& light, const BoundaryPlane& plane) {
  // The line of images by two nodes of Gauss-Laguerre quadrature.
  constexpr float kNode[] = {0.5857864f, 3.4142136f}, kWeight[] = {0.8535534f, 0.1464466f};
  const Vec3& n = plane.normal;
  const Vec3 origin = light.origin - n * (2 * dot(light.origin - plane.point, n));
  const Vec3 direction = light.direction - n * (2 * dot(light.direction, n));
  std::array<WeightedStretch, 4> lights{{{light, 1}, {{origin, direction, light.length}, 1}}};
  for (size_t i = 0; i < 2; ++i)
    lights[2 + i] = {{origin + n * (kNode[i] * plane.extrapolation), direction, light.length}, -2 * kWeight[i]};
  return lights;
}

Spectrum bounded_source_radiance(const MultipleScattering& scattering, const Stretch& light,
                                 const BoundaryPlanes& planes, const Vec3& x, const Vec3& w) {
  const Spectrum alone = scattering.source_radiance(light, x, w);
  Spectrum result = alone;
  for (const BoundaryPlane& plane : planes) {
    if (result.is_black()) break;
    // Where the boundary is bent inwards either end may lie outside: then it is the plane that touches that end.
    BoundaryPlane touching = plane;
    const float beyond = std::max(dot(light.origin - plane.point, plane.normal), dot(x - plane.point, plane.normal));
    touching.point += plane.normal * std::max(beyond, 0.0f);
    const Spectrum bounded = scattering.source_radiance(with_images(light, touching), x, w);
    for (int c = 0; c < kChannels; ++c)
      if (alone[c] > 0) result[c] *= std::pow(bounded[c] / alone[c], plane.share);
  }
  return result;
}

}  // namespace turbid
