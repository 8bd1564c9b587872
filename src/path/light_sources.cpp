#include "path/light_sources.h"

namespace turbid {

namespace {

/// Of rays, where there is something to aim at.
constexpr float kAimed = 0.5f;

/// Cosine of the half angle under which a ball is seen; -1 from inside.
float cosine_of(const Ball& ball, const Vec3& from) {
  const float sine2 = sqr(ball.radius) / length_squared(ball.center - from);
  return sine2 < 1 ? std::sqrt(1 - sine2) : -1;
}
/// Of a direction from there that is uniform in the cone to the ball, 1/sr.
float cone_pdf_w(const Ball& ball, const Vec3& from, const Vec3& direction) {
  const float cosine = cosine_of(ball, from);
  return cosine == -1 || dot(direction, normalize(ball.center - from)) >= cosine ? 1 / (2 * kPi * (1 - cosine)) : 0;
}
bool line_meets(const Ball& ball, const Vec3& from, const Vec3& direction) {
  return length_squared(cross(ball.center - from, direction)) <= sqr(ball.radius);
}

}  // namespace

LightSources::LightSources(const Scene& scene, bool sees_media, std::vector<Ball> targets)
    : scene_(scene), sees_media_(sees_media && !scene.media().empty()), targets_(std::move(targets)) {
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
  find_aims();
}

void LightSources::find_aims() {
  std::vector<float> powers;
  for (size_t s = 0; s < sources_.size(); ++s) {
    const Emitter& emitter = *sources_[s].emitter;
    const float power = emitter.power().mean();
    const auto ray = emitter.sample_emission(Vec2(0.5f), Vec2(0.5f));
    const bool open = ray && emitter.emission_towards(*ray, ray->direction);
    if (!(power > 0) || !ray || !(open || emitter.is_at_infinity())) continue;
    for (size_t t = 0; t < targets_.size(); ++t) {
      const Ball& target = targets_[t];
      const float cosine = emitter.is_at_infinity() ? 1 : cosine_of(target, emitter.bounds().center());
      if (cosine == -1) continue;  // all around it
      const float share = emitter.is_at_infinity() ? ray->pdf.pdf_a * kPi * sqr(target.radius) : (1 - cosine) / 2;
      aims_.push_back({s, t});
      powers.push_back(power * share);
    }
  }
  if (!aims_.empty()) aim_distribution_ = DiscreteDistribution(powers);
}

std::optional<EmissionSample> LightSources::aim(const Source& source, const Ball& target, const EmissionSample& ray,
                                                const Vec2& u) const {
  EmissionSample aimed = ray;
  if (source.emitter->is_at_infinity()) {
    // Back to the sphere that the light's own rays begin on: media that fill the world end there.
    const Vec3 through = start_from_infinity(target.center, target.radius, ray.direction, u) - scene_.center();
    const float along = dot(through, ray.direction), radius2 = 1 / (kPi * ray.pdf.pdf_a);
    aimed.origin = scene_.center() + through -
                   ray.direction * (along + safe_sqrt(along * along + radius2 - length_squared(through)));
    return aimed;
  }
  const float cosine = cosine_of(target, ray.origin);
  const Vec3 axis = cosine == -1 ? ray.direction : normalize(target.center - ray.origin);
  aimed.direction = direction_about(axis, 1 - u.x * (1 - cosine), 2 * kPi * u.y);
  return aimed;
}

Spectrum LightSources::weigh(size_t source, const EmissionSample& ray) const {
  const Emitter& emitter = *sources_[source].emitter;
  const bool infinite = emitter.is_at_infinity();
  const auto intensity = infinite ? std::nullopt : emitter.emission_towards(ray, ray.direction);
  const EmissionPdf own = emitter.emission_pdf(ray.ng, ray.direction);
  // Of what may be chosen in two ways: the start of rays from infinity, else the direction.
  float density = (1 - kAimed) * distribution_.prob(source) * (infinite ? own.pdf_a : intensity ? own.pdf_w : 1);
  for (size_t a = 0; a < aims_.size(); ++a) {
    if (aims_[a].source != source) continue;
    const Ball& target = targets_[aims_[a].target];
    density += kAimed * aim_distribution_.prob(a) *
               (!infinite                                       ? cone_pdf_w(target, ray.origin, ray.direction)
                : line_meets(target, ray.origin, ray.direction) ? 1 / (kPi * sqr(target.radius))
                                                                : 0);
  }
  return (infinite ? ray.weight * own.pdf_a : intensity ? *intensity : ray.weight) / density;
}

std::optional<Emission> LightSources::sample(Sampler& sampler) const {
  const float u_choice = sampler.next_1d();
  const Vec2 u_position = sampler.next_2d(), u_direction = sampler.next_2d();
  if (sources_.empty()) return std::nullopt;
  const bool aimed = !aims_.empty() && u_choice < kAimed;
  const float u_among = aims_.empty() ? u_choice : aimed ? u_choice / kAimed : (u_choice - kAimed) / (1 - kAimed);
  const DiscreteSample chosen = (aimed ? aim_distribution_ : distribution_).sample(u_among);
  const size_t index = aimed ? aims_[chosen.index].source : chosen.index;
  const Source& source = sources_[index];
  auto ray = source.emitter->sample_emission(u_position, u_direction);
  if (ray && aimed)
    ray = aim(source, targets_[aims_[chosen.index].target], *ray,
              source.emitter->is_at_infinity() ? u_position : u_direction);
  if (!ray || ray->weight.is_black()) return std::nullopt;
  const Spectrum flux = aims_.empty() ? ray->weight / chosen.prob : weigh(index, *ray);
  if (flux.is_black()) return std::nullopt;
  Emission emission{source.emitter, index,         source.object, *ray, distribution_.prob(index),
                    flux,           source.medium, source.media};
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
