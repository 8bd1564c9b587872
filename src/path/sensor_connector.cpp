#include "path/sensor_connector.h"

#include <array>

namespace turbid {

SensorConnector::SensorConnector(const Scene& scene, double paths, const Sampler& sampler, SampleCounters& counters)
    : scene_(scene),
      film_(scene.film()),
      crop_(film_.image_size()),
      // The mean over the film, times its pixels, is the integral over the film in units of pixels.
      scale_(static_cast<float>(static_cast<double>(film_.size.x) * static_cast<double>(film_.size.y) / paths)),
      sampler_(sampler),
      counters_(counters) {
  if (scene.sensor().aperture_point(Vec2(0.5f))) view_ = find_view(Vec2(0.5f));
}

/// What a rectangle of film sees is the convex hull of four rays.
Cone SensorConnector::find_view(const Vec2& u_aperture) const {
  const float support = film_.filter.support();
  std::array<Vec3, 4> corners;
  Vec3 sum(0);
  for (size_t i = 0; i < corners.size(); ++i) {
    const auto edge = [&](bool far, int offset, int size, int whole) {
      const float at = far ? static_cast<float>(offset + size) + support : static_cast<float>(offset) - support;
      return at / static_cast<float>(whole);
    };
    const Vec2 film(edge(i & 1, film_.crop_offset.x, crop_.x, film_.size.x),
                    edge(i & 2, film_.crop_offset.y, crop_.y, film_.size.y));
    corners[i] = scene_.sensor().sample_ray(film, u_aperture).ray.direction;
    sum = sum + corners[i];
  }
  const Vec3 axis = normalize(sum);
  double half_angle = 0;
  for (const Vec3& corner : corners) half_angle = std::max(half_angle, angle_between(axis, corner));
  constexpr double kRounding = 1e-5;
  return {axis, half_angle + kRounding};
}

template <class Look>
std::optional<SensorArrival> SensorConnector::arrive_by(const SensorConnection& way, const Vec3& origin,
                                                        const Spectrum& flux, const Look& look) const {
  if (flux.is_black()) return std::nullopt;
  const auto target = target_of(way);
  if (!target) return std::nullopt;
  const Vec3 towards = way.position - origin;
  const float distance = length(towards);
  const Vec3 wo = towards / distance;
  const Spectrum near = near_part(way, -wo), arrived = flux * near;
  // What stands nearer than the near plane is not there.
  const Ray line{origin, wo, distance - way.near_t};
  if (arrived.is_black() || !(line.t_max > 0)) return std::nullopt;
  const Passage passage = look(line, arrived);
  if (passage.prob == 0) return std::nullopt;
  return arrival(*target, way, near * passage.transmittance, passage.proxy);
}

std::optional<SensorArrival> SensorConnector::arrive(const SensorConnection& way, const Vec3& origin,
                                                     const Spectrum& flux, const Traveller& traveller,
                                                     const SurfaceEvent* surface) const {
  return arrive_by(way, origin, flux, [&](const Ray& line, const Spectrum& arrived) {
    return traveller.look_along(line, arrived, surface);
  });
}

std::optional<SensorArrival> SensorConnector::arrive(const SensorConnection& way, const Vec3& origin,
                                                     const Spectrum& flux, const Medium* medium) const {
  return arrive_by(way, origin, flux, [&](const Ray& line, const Spectrum& arrived) {
    return pass_straight(scene_, line, medium, arrived, sampler_, counters_);
  });
}

/// Lights with a surface shine alike in all directions of their outside: the radiance that the emitted ray stands for
/// holds for the way to the sensor too.
std::optional<SensorArrival> SensorConnector::arrive_from(const Emission& emission, const Traveller& traveller) const {
  if (emission.emitter->is_environment()) return arrive_from_sky(emission);
  if (!emission.object) return std::nullopt;
  const EmissionSample& ray = emission.ray;
  const auto way = way_from(ray.origin);
  if (!way) return std::nullopt;
  const Vec3 wo = normalize(way->position - ray.origin);
  const float cosine = dot(ray.ng, wo), cosine_of_ray = dot(ray.ng, ray.direction);
  if (!(cosine > 0) || !(cosine_of_ray > 0)) return std::nullopt;
  auto result = arrive(*way, ray.origin, emission.throughput, traveller);
  if (!result) return std::nullopt;
  result->weight *= ray.pdf.pdf_w / cosine_of_ray * cosine;
  return result;
}

/// The sky behind everything: an edge from infinity.
std::optional<SensorArrival> SensorConnector::arrive_from_sky(const Emission& emission) const {
  const Vec3 towards = -emission.ray.direction;
  Rng rng = sampler_.aside(Purpose::kAperture, towards);
  const auto way = scene_.sensor().connect_to_infinity(towards, next_2d(rng));
  if (!way) return std::nullopt;
  const auto target = target_of(*way);
  if (!target) return std::nullopt;
  Ray line{way->position + towards * way->near_t, towards, way->far_t - way->near_t};
  // Media without end stop at the end of the world, even if things are visible farther away.
  if (line.t_max >= scene_.distance_to_world_end(line)) line.t_max = kInfinity;
  const Spectrum near = near_part(*way, towards), arrived = emission.throughput * near;
  if (arrived.is_black()) return std::nullopt;
  const bool stacked = scene_.has_priorities();
  const Medium* medium = stacked ? scene_.sensor_media().medium() : scene_.sensor_medium();
  const Passage passage =
      pass_straight(scene_, line, medium, arrived, sampler_, counters_, stacked ? &scene_.sensor_media() : nullptr);
  if (passage.prob == 0) return std::nullopt;
  return arrival(*target, *way, near * passage.transmittance * emission.ray.pdf.pdf_a, passage.proxy);
}

SensorArrival SensorConnector::arrival(const SplatTarget& target, const SensorConnection& way, const Spectrum& factor,
                                       const Spectrum& proxy) const {
  return {target, factor * (way.importance * target.weight * scale_), pdf(way), proxy, way.position};
}

Spectrum SensorConnector::near_part(const SensorConnection& way, const Vec3& direction) const {
  const Medium* medium = way.near_t > 0 ? scene_.sensor_medium() : nullptr;
  if (!medium) return Spectrum(1.0f);
  return medium->transmittance({way.position, direction, way.near_t}, sampler_);
}

std::optional<SplatTarget> SensorConnector::target_of(const SensorConnection& way) const {
  const Vec2 position(way.film.x * static_cast<float>(film_.size.x) - static_cast<float>(film_.crop_offset.x),
                      way.film.y * static_cast<float>(film_.size.y) - static_cast<float>(film_.crop_offset.y));
  const float support = film_.filter.support();
  const bool near = position.x >= -support && position.x <= static_cast<float>(crop_.x) + support &&
                    position.y >= -support && position.y <= static_cast<float>(crop_.y) + support;
  if (!near) return std::nullopt;
  Rng rng = sampler_.aside(Purpose::kSplat, way.position, Vec3(way.film.x, way.film.y, 0));
  const SplatTarget target = choose_pixel(film_.filter, position, next_2d(rng));
  const Vec2i& pixel = target.pixel;
  if (target.weight == 0 || pixel.x < 0 || pixel.y < 0 || pixel.x >= crop_.x || pixel.y >= crop_.y) return std::nullopt;
  return target;
}

}  // namespace turbid
