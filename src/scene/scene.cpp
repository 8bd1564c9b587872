#include "scene/scene.h"

#include <algorithm>
#include <array>

#include "core/error.h"

namespace turbid {
namespace {

/// Lights at infinity and lights in the scene share the choice evenly: the power of a sky is that of a disk around the
/// whole scene and says nothing about what reaches any one place. Within each group power decides, but no light gets
/// less than half of the average: lamps that are weak beside a sun are bright next to them, and white specks if seldom
/// asked.
DiscreteDistribution distribution_of_choice(const std::vector<const Emitter*>& emitters) {
  constexpr float kLeastShare = 0.5f;
  float sums[2] = {}, counts[2] = {};
  for (const Emitter* emitter : emitters) {
    if (!emitter->can_be_aimed_at()) continue;
    sums[emitter->is_at_infinity()] += std::max(0.0f, emitter->power().mean());
    counts[emitter->is_at_infinity()] += 1;
  }
  std::vector<float> weights;
  for (const Emitter* emitter : emitters) {
    if (!emitter->can_be_aimed_at()) {
      weights.push_back(0);
      continue;
    }
    const bool group = emitter->is_at_infinity();
    const float share = sums[group] > 0 ? std::max(0.0f, emitter->power().mean()) / sums[group] : 0;
    weights.push_back(std::max(share, kLeastShare / counts[group]));
  }
  return DiscreteDistribution(weights);
}

}  // namespace

Scene::Scene(SceneParts parts) : parts_(std::move(parts)) {
  if (!parts_.sensor) throw SceneError("the scene has no sensor: nothing says where the picture is taken from");
  std::vector<std::shared_ptr<const Shape>> shapes;
  for (const Object& object : parts_.objects) shapes.push_back(object.shape);
  rays_ = std::make_unique<RayCaster>(std::move(shapes));

  const Bounds3& bounds = rays_->bounds();
  if (!bounds.isEmpty()) {
    center_ = bounds.center();
    radius_ = std::max(length(bounds.max - bounds.min) / 2, std::numeric_limits<float>::min());
  }

  for (const auto& emitter : parts_.emitters) {
    emitter->set_scene_bounds(center_, radius_);
    emitters_.push_back(emitter.get());
  }
  for (const Object& object : parts_.objects) {
    if (object.emitter) emitters_.push_back(object.emitter.get());
    if (object.bsdf->flags() & lobe::kNull) has_null_surfaces_ = true;
  }
  choose_probabilities();
  measure_world();

  find_enclosures();
  const Vec3& eye = parts_.sensor->position();
  if (has_priorities_) sensor_media_ = media_at(eye);
  sensor_medium_ = parts_.sensor_medium_declared && !has_priorities_ ? parts_.sensor_medium.get() : medium_at(eye);
  find_media();

  // Rays from infinity must start where the media end that lie on their way. (Choices by power stay as they are: this
  // group of lights grows as one.)
  if (has_unbounded_media())
    for (const auto& emitter : parts_.emitters) emitter->set_scene_bounds(center_, world_radius_);
}

void Scene::measure_world() {
  world_radius_ = std::max(kWorldScale * radius_, length(parts_.sensor->position() - center_));
  for (const Emitter* emitter : emitters_) {
    if (emitter->is_at_infinity()) continue;
    const Vec3 low = abs(emitter->bounds().min - center_), high = abs(emitter->bounds().max - center_);
    const Vec3 farthest(std::max(low.x, high.x), std::max(low.y, high.y), std::max(low.z, high.z));
    world_radius_ = std::max(world_radius_, length(farthest));
  }
}

const Medium* Scene::thinnest_medium() const {
  const auto thinnest = std::max_element(
      media_.begin(), media_.end(), [](const auto& a, const auto& b) { return a.mean_free_path < b.mean_free_path; });
  return thinnest == media_.end() ? nullptr : thinnest->medium;
}

bool Scene::has_unbounded_media() const {
  return std::any_of(media_.begin(), media_.end(), [](const Surroundings& m) { return !m.bounded; });
}

void Scene::find_enclosures() {
  const Medium* world = parts_.world_medium.get();
  has_priorities_ = world || std::any_of(parts_.objects.begin(), parts_.objects.end(),
                                         [](const Object& object) { return object.priority_declared; });
  if (!has_priorities_) return;
  has_null_surfaces_ = true;
  for (Object& object : parts_.objects) {
    const bool lets_in = object.bsdf->flags() & (lobe::kTransmission | lobe::kNull);
    object.encloses = object.interior || object.priority_declared ||
                      (world && lets_in && !object.bounds_media && object.shape->is_closed());
  }
}

void Scene::choose_probabilities() {
  emitter_distribution_ = distribution_of_choice(emitters_);
  size_t index = 0;
  for (const auto& emitter : parts_.emitters) {
    if (emitter->is_environment())
      environments_.push_back(
          {static_cast<const EnvironmentEmitter*>(emitter.get()), emitter_distribution_.prob(index), index});
    ++index;
  }
  for (const Object& object : parts_.objects)
    object_emitter_index_.push_back(object.emitter ? index++ : emitters_.size());
}

void Scene::find_media() {
  const auto remember = [&](const Medium* medium) {
    const bool known = std::any_of(media_.begin(), media_.end(), [&](const auto& m) { return m.medium == medium; });
    if (medium && !known) media_.push_back(survey(medium));
  };
  remember(sensor_medium_);
  remember(parts_.world_medium.get());
  if (parts_.sensor_medium_declared) remember(parts_.sensor_medium.get());
  for (const Object& object : parts_.objects) {
    remember(object.interior.get());
    remember(object.exterior.get());
  }
}

Surroundings Scene::survey(const Medium* medium) const {
  Surroundings result{.medium = medium,
                      .bounded = true,
                      .blind = true,
                      .dense = false,
                      .sealed = true,
                      .mean_free_path = 1 / medium->max_sigma_t()};
  // A medium that was declared for the sensor, or lies outside of a shape, may be without end.
  if (parts_.sensor_medium_declared && medium == parts_.sensor_medium.get()) result.bounded = false;
  if (medium == parts_.world_medium.get()) result.bounded = false;
  Bounds3 extent;
  float thinnest = kInfinity;
  bool cheap_clearance = true;
  for (size_t i = 0; i < parts_.objects.size(); ++i) {
    const Object& object = parts_.objects[i];
    if (object.exterior.get() == medium) {
      result.bounded = false;
      if (object.bsdf->flags() & lobe::kNull) result.sealed = false;
    }
    if (object.interior.get() != medium) continue;
    if (!object.shape->is_closed()) result.bounded = false;
    if (!rays_->has_cheap_clearance(static_cast<uint32_t>(i))) cheap_clearance = false;
    if (object.bsdf->flags() & lobe::kNull) result.blind = result.sealed = false;
    const Bounds3 box = object.shape->bounds();
    const Vec3 size = box.size();
    thinnest = std::min({thinnest, size.x, size.y, size.z});
    extent.extendBy(box);
  }
  const bool lit_inside = std::any_of(emitters_.begin(), emitters_.end(), [&](const Emitter* emitter) {
    return !emitter->is_at_infinity() && emitter->bounds().intersects(extent);
  });
  // With priorities a medium may also end where another one begins.
  if (!result.bounded || lit_inside || has_priorities_) result.blind = false;
  if (!result.bounded || has_priorities_) result.sealed = false;
  constexpr float kDenseThickness = 8;  // mean free paths across
  result.dense = result.bounded && cheap_clearance && thinnest > kDenseThickness * result.mean_free_path;
  return result;
}

EmitterChoice Scene::choose_emitter(float& u) const {
  if (!(emitter_distribution_.sum() > 0)) return {nullptr, 0, 0};
  if (emitters_.size() == 1) return {emitters_[0], 1, 0};
  const DiscreteSample chosen = emitter_distribution_.sample(u);
  u = chosen.u;
  return {emitters_[chosen.index], chosen.prob, chosen.index};
}

MediumStack Scene::media_at(const Vec3& p) const {
  const bool declared = parts_.sensor_medium_declared && p == parts_.sensor->position();
  MediumStack stack(declared ? parts_.sensor_medium.get() : world_medium());
  // A shape encloses p when a ray from there leaves it more often than it enters it.
  std::vector<int> exits(parts_.objects.size());
  Ray ray{p, normalize(Vec3(0.0317f, 0.0173f, 1))};
  while (const Hit hit = rays_->intersect(ray)) {
    exits[hit.shape] += leads_outside(hit.ng, ray.direction) ? 1 : -1;
    ray.origin = parts_.objects[hit.shape].shape->surface_point(ray, hit).leave(ray.direction);
  }
  for (size_t i = 0; i < exits.size(); ++i)
    for (int n = 0; n < exits[i] && parts_.objects[i].encloses; ++n) stack.enter(parts_.objects[i]);
  return stack;
}

const Medium* Scene::medium_at(const Vec3& p) const {
  if (has_priorities_) return media_at(p).medium();
  // Any direction tells for closed boundaries; open ones (a water surface) are met by one of six that avoid symmetry
  // axes.
  constexpr float kTilt = 0.0317f, kTwist = 0.0173f;
  const std::array<Vec3, 6> directions = {Vec3{kTilt, kTwist, 1},  Vec3{kTwist, kTilt, -1}, Vec3{kTilt, 1, kTwist},
                                          Vec3{kTwist, -1, kTilt}, Vec3{1, kTilt, kTwist},  Vec3{-1, kTwist, kTilt}};
  for (const Vec3& towards : directions) {
    Ray ray{p, normalize(towards)};
    while (const Hit hit = rays_->intersect(ray)) {
      const Object& object = parts_.objects[hit.shape];
      if (object.bounds_media) return object.medium_towards(hit.ng, -ray.direction);
      ray.origin = object.shape->surface_point(ray, hit).leave(ray.direction);
    }
  }
  return nullptr;
}

const Surroundings& Scene::surroundings(const Medium* medium) const {
  return *std::find_if(media_.begin(), media_.end(), [&](const auto& m) { return m.medium == medium; });
}

float Scene::distance_to_world_end(const Ray& ray) const {
  const Vec3 to_center = center_ - ray.origin;
  const float along = dot(to_center, ray.direction);
  const float discriminant = sqr(world_radius_) - (length_squared(to_center) - sqr(along));
  return discriminant > 0 ? std::max(0.0f, along + std::sqrt(discriminant)) : 0;
}

}  // namespace turbid
