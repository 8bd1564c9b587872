#include "path/light_sources.h"

namespace turbid {

LightSources::LightSources(const Scene& scene, bool sees_media)
    : scene_(scene), sees_media_(sees_media && !scene.media().empty()) {
  std::vector<const Object*> objects;
  for (const Object& object : scene.objects())
    if (object.emitter) objects.push_back(&object);
  // Scene::emitters: those without a surface, then those of objects in their order.
  const size_t without_surface = scene.emitters().size() - objects.size();
  std::vector<float> powers;
  float sum = 0;
  for (size_t i = 0; i < scene.emitters().size(); ++i) {
    Source source{scene.emitters()[i], i < without_surface ? nullptr : objects[i - without_surface]};
    const Bounds3 bounds = source.emitter->bounds();
    source.stays_in_one_place = !source.object && !source.emitter->is_at_infinity() && bounds.min == bounds.max;
    if (sees_media_ && source.stays_in_one_place) {
      if (scene.has_priorities()) source.media = scene.media_at(bounds.min);
      source.medium = scene.has_priorities() ? source.media.medium() : medium_towards_sensor(bounds.min);
    }
    sources_.push_back(source);
    powers.push_back(std::max(0.0f, source.emitter->power().mean()));
    sum += powers.back();
  }
  // A poor estimate of the power must not make a light unreachable.
  constexpr float kLeastShare = 1e-3f;
  for (float& power : powers)
    power = std::max(sum > 0 ? power / sum : 1, kLeastShare / static_cast<float>(powers.size()));
  if (!powers.empty()) distribution_ = DiscreteDistribution(powers);
}

std::optional<Emission> LightSources::sample(Sampler& sampler) const {
  const float u_choice = sampler.next_1d();
  const Vec2 u_position = sampler.next_2d(), u_direction = sampler.next_2d();
  if (sources_.empty()) return std::nullopt;
  const DiscreteSample chosen = distribution_.sample(u_choice);
  const Source& source = sources_[chosen.index];
  const auto ray = source.emitter->sample_emission(u_position, u_direction);
  if (!ray || ray->weight.is_black()) return std::nullopt;
  Emission emission{source.emitter, chosen.index, source.object, *ray, chosen.prob, ray->weight / chosen.prob,
                    source.medium,  source.media};
  if (sees_media_ && !source.stays_in_one_place) find_medium(source, emission);
  return emission;
}

void LightSources::find_medium(const Source& source, Emission& emission) const {
  const EmissionSample& ray = emission.ray;
  if (scene_.has_priorities()) {
    emission.media = scene_.media_at(ray.origin);
    emission.medium = emission.media.medium();
  } else if (source.object && source.object->bounds_media) {
    emission.medium = source.object->medium_towards(ray.ng, ray.direction);
  } else if (!source.emitter->is_at_infinity() || scene_.has_unbounded_media()) {
    emission.medium = medium_towards_sensor(ray.origin);
  }
}

const Medium* LightSources::medium_towards_sensor(const Vec3& p) const {
  const Vec3 way = scene_.sensor().position() - p;
  const float distance = length(way);
  if (!(distance > 0)) return scene_.sensor_medium();
  Ray rest{p, way / distance, distance};
  while (const Hit hit = scene_.rays().intersect(rest)) {
    const Object& object = scene_.object(hit);
    if (object.bounds_media) return object.medium_towards(hit.ng, -rest.direction);
    rest.origin = object.shape->surface_point(rest, hit).leave(rest.direction);
    rest.t_max -= hit.t;
  }
  return scene_.sensor_medium();
}

}  // namespace turbid
