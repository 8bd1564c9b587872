#include "integrator/plain_tracer.h"

#include "medium/homogeneous.h"

namespace turbid::testing {
namespace {

Spectrum emitted(const Scene& scene, const Hit& hit, const Ray& ray) {
  Spectrum sum(0.0f);
  if (!hit) {
    for (const ChosenEnvironment& environment : scene.environments()) sum += environment.emitter->Le(ray.direction);
  } else if (const Object& object = scene.object(hit); object.emitter) {
    sum = object.emitter->Le(object.shape->surface_point(ray, hit), -ray.direction);
  }
  return sum;
}

bool is_null(lobe::Flags flags) { return flags & lobe::kNull; }

}  // namespace

PixelSample PlainTracer::sample_radiance(const Scene& scene, const SensorRay& camera, Sampler& sampler,
                                         SampleCounters& counters) const {
  Spectrum f(camera.weight), pdf(1.0f), radiance(0.0f);
  Ray ray = camera.ray;
  const Medium* medium = scene.sensor_medium();
  const int channel = std::min(static_cast<int>(sampler.next_1d() * kChannels), kChannels - 1);
  float eta_scale = 1;
  for (int depth = 0; depth < max_depth_;) {
    ++counters.rays;
    const Hit hit = scene.rays().intersect(ray);
    if (medium) {
      const Spectrum sigma_t = medium->sigma_t();
      const float t = -std::log1p(-sampler.next_1d()) / sigma_t[channel];
      const float end = hit ? hit.t : scene.distance_to_world_end(ray);
      const auto attenuate = [&](float distance) {
        Spectrum T;
        for (int c = 0; c < kChannels; ++c) T[c] = std::exp(-sigma_t[c] * distance);
        f *= T;
        pdf *= T;
      };
      if (t < end) {
        attenuate(t);
        f *= medium->sigma_s();
        pdf *= sigma_t;
        const float mu = medium->phase().sample(sampler.next_1d());
        ray = {ray.at(t), direction_about(ray.direction, mu, 2 * kPi * sampler.next_1d())};
        ++depth;
      } else {
        attenuate(end);
      }
      if (t < end) {
        const float keep = depth < 5 ? 1 : std::min(0.95f, (f / pdf.mean()).max() * eta_scale);
        if (sampler.next_1d() >= keep) break;
        f /= keep;
        // Keeps both far from underflow; only their ratio counts.
        const float scale = 1 / pdf.mean();
        f *= scale;
        pdf *= scale;
        continue;
      }
    }
    radiance += f / pdf.mean() * emitted(scene, hit, ray);
    if (!hit) break;
    const Object& object = scene.object(hit);
    const SurfacePoint point = object.shape->surface_point(ray, hit);
    const auto sample = object.bsdf->sample(point, point.to_local(-ray.direction), sampler.next_1d(), sampler.next_2d(),
                                            TransportMode::kRadiance);
    if (!sample) break;
    const Vec3 direction = point.to_world(sample->direction);
    f *= sample->weight;
    eta_scale *= sample->eta * sample->eta;
    if (object.bounds_media) medium = object.medium_towards(point.ng, direction);
    ray = {point.leave(direction), direction};
    if (!is_null(sample->flags)) ++depth;
  }
  return {radiance, 1};
}

}  // namespace turbid::testing
