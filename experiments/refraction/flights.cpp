#include "flights.h"

#include "integrator/camera_sample.h"
#include "methods.h"
#include "render/statistics.h"

namespace turbid::experiments {

Flights::Flights(const std::string& file, const std::vector<std::string>& definitions)
    : loaded_(load_scene(file, overrides(definitions))), scene_(std::move(loaded_.parts)) {
  Sampler sampler(SamplerKind::kIndependent, 1);
  const Vec2i size = scene_.film().image_size();
  for (int y = 0; y < size.y; ++y)
    for (int x = 0; x < size.x; ++x) add(start_camera_sample(scene_, {x, y}, 0, sampler).ray);
}

void Flights::add(const Ray& ray) {
  const Hit hit = scene_.rays().intersect(ray);
  if (!hit) return;
  const Object& object = scene_.object(hit);
  if (!object.interior) return;
  const SurfacePoint point = object.shape->surface_point(ray, hit);
  const auto bent = object.bsdf->sample(point, point.to_local(-ray.direction), kOneMinusEpsilon, Vec2(0.5f),
                                        TransportMode::kRadiance);
  if (!bent || !(bent->flags & lobe::kTransmission)) return;
  const Vec3 direction = point.to_world(bent->direction);
  Ray flight{point.leave(direction), direction};
  const Hit end = scene_.rays().intersect(flight);
  if (!end) return;
  flight.t_max = end.t;
  medium_ = object.interior;
  flights_.push_back(flight);
}

Flights::Rendering Flights::render(const RefractiveSettings& settings, uint64_t index, size_t stride) const {
  const RefractiveScattering scattering(scene_, settings);
  Sampler sampler(SamplerKind::kIndependent, 7);
  Rendering result;
  const double start = process_cpu_seconds();
  for (size_t i = 0; i < flights_.size(); i += stride) {
    sampler.start(i, index);
    const Spectrum value = scattering.gather(flights_[i], *medium_, Spectrum(1.0f), sampler, result.counters);
    result.values.push_back(static_cast<double>(value.mean()));
  }
  result.seconds = (process_cpu_seconds() - start) / static_cast<double>(result.values.size());
  return result;
}

std::vector<double> Flights::radiance_along(const Ray& flight, size_t points, int starts) const {
  const RefractiveScattering scattering(
      scene_, {.method = RefractiveMethod::kPointSampling, .samples = 1, .in_middle = true, .starts = starts});
  Sampler sampler(SamplerKind::kIndependent, 7);
  sampler.start(0, 0);
  SampleCounters counters;
  const float step = flight.t_max / static_cast<float>(points);
  std::vector<double> result;
  for (size_t i = 0; i < points; ++i) {
    const float t = step * static_cast<float>(i);
    const Ray piece{flight.at(t), flight.direction, step};
    const Spectrum way = medium_->transmittance({flight.origin, flight.direction, t}, sampler);
    const Spectrum value = scattering.gather(piece, *medium_, way, sampler, counters) * way;
    result.push_back(static_cast<double>(value.mean() / step));
  }
  return result;
}

double mean_of(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

double mean_square_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (size_t i = 0; i < a.size(); ++i) sum += sqr(a[i] - b[i]);
  return sum / static_cast<double>(a.size());
}

}  // namespace turbid::experiments
