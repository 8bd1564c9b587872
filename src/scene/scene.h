#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/distribution.h"
#include "emitter/emitter.h"
#include "geometry/ray_caster.h"
#include "image/cascades.h"
#include "image/filter.h"
#include "medium/medium.h"
#include "scene/medium_stack.h"
#include "sensor/sensor.h"
#include "surface/bsdf.h"

namespace turbid {

/// One thing in the scene: a shape and what it is made of.
struct Object {
  std::shared_ptr<const Shape> shape;
  std::shared_ptr<const Bsdf> bsdf;
  std::shared_ptr<const Medium> interior, exterior;  ///< null: vacuum
  bool bounds_media = false;                ///< interior or exterior was declared: crossing it changes the medium
  std::shared_ptr<SurfaceEmitter> emitter;  ///< null: does not shine
  std::string id;                           ///< name in the scene file, for messages
  int priority = 0;                         ///< see MediumStack
  bool priority_declared = false;
  bool encloses = false;  ///< for MediumStack; found by Scene

  /// The medium on the side that `direction` (pointing away from the surface) leads to.
  const Medium* medium_towards(const Vec3& ng, const Vec3& direction) const {
    return leads_outside(ng, direction) ? exterior.get() : interior.get();
  }
};

/// The film that a sensor exposes; sizes in pixels.
struct FilmSettings {
  Vec2i size{768, 576};
  Vec2i crop_offset{0, 0};
  Vec2i crop_size{0, 0};  ///< 0: no crop, the whole film
  ReconstructionFilter filter;
  bool alpha = false;                         ///< write an alpha channel
  std::optional<OutlierSettings> outliers{};  ///< take outliers from the picture

  /// Of the image that the film exposes: the crop window, or all of it.
  const Vec2i& image_size() const { return crop_size.x > 0 ? crop_size : size; }
};

inline size_t pixel_count(const FilmSettings& film) {
  return static_cast<size_t>(film.image_size().x) * static_cast<size_t>(film.image_size().y);
}

/// What a Scene is assembled from. `sensor_medium` is only looked at when `sensor_medium_declared`.
struct SceneParts {
  std::vector<Object> objects;
  std::vector<std::shared_ptr<Emitter>> emitters;  ///< without those of objects
  std::shared_ptr<const Sensor> sensor;
  std::shared_ptr<const Medium> sensor_medium;
  bool sensor_medium_declared = false;
  std::shared_ptr<const Medium> world_medium;  ///< fills what no shape encloses; null: vacuum
  FilmSettings film;
  SamplerKind sampler = SamplerKind::kIndependent;
  uint32_t sample_count = 16;
};

/// An emitter chosen for next-event estimation, with its probability and its place in Scene::emitters.
struct EmitterChoice {
  const Emitter* emitter;
  float prob;
  size_t index;
};

/// A light at infinity with the probability that choose_emitter returns it, and its place in Scene::emitters.
struct ChosenEnvironment {
  const EnvironmentEmitter* emitter;
  float prob;
  size_t index;
};

/// What is known beforehand about the space that a medium fills.
struct Surroundings {
  const Medium* medium = nullptr;
  /// Every way out of the medium leads through a closed surface.
  bool bounded = false;
  /// No straight line that starts inside can reach a light: every boundary bends or blocks light and no light touches
  /// the inside. Next-event estimation from there would always be zero.
  bool blind = false;
  /// Many mean free paths thick, so that most flights end far from any boundary, and inside of spheres, whose distance
  /// is cheap to ask for (RayCaster::has_cheap_clearance).
  bool dense = false;
  /// Nothing passes straight through its boundary: no line joins the inside with the outside.
  bool sealed = false;
  float mean_free_path = 0;  ///< the shortest of any channel
};

/// The assembled scene: immutable while rendering, shared between threads.
class Scene {
 public:
  explicit Scene(SceneParts parts);

  const std::vector<Object>& objects() const { return parts_.objects; }
  const Object& object(const Hit& hit) const { return parts_.objects[hit.shape]; }
  const RayCaster& rays() const { return *rays_; }
  const std::vector<const Emitter*>& emitters() const { return emitters_; }
  const std::vector<ChosenEnvironment>& environments() const { return environments_; }
  const Sensor& sensor() const { return *parts_.sensor; }
  const FilmSettings& film() const { return parts_.film; }
  SamplerKind sampler() const { return parts_.sampler; }
  uint32_t sample_count() const { return parts_.sample_count; }

  /// Chooses an emitter for next-event estimation, by its power among its like; empty scenes give null. `u` is rescaled
  /// for reuse.
  EmitterChoice choose_emitter(float& u) const;
  /// Probability that choose_emitter returns the emitter with this place in emitters().
  float choice_prob(size_t emitter) const { return emitter_distribution_.prob(emitter); }
  /// The place in emitters() of the light that was hit; only where one was.
  size_t emitter_index(const Hit& hit) const { return object_emitter_index_[hit.shape]; }

  /// Medium that the sensor stands in: declared by the file, else found by casting a ray (`medium_at`).
  const Medium* sensor_medium() const { return sensor_medium_; }
  bool sensor_medium_declared() const { return parts_.sensor_medium_declared; }
  /// The medium around p: that on the near side of the first surface that bounds media, seen from p. Null: vacuum. In
  /// scenes with priorities that of media_at.
  const Medium* medium_at(const Vec3& p) const;
  /// The scene declares a priority or a world medium: walks find their way through media with a MediumStack.
  bool has_priorities() const { return has_priorities_; }
  /// The shapes around p, counted by the surfaces that one ray from p meets.
  MediumStack media_at(const Vec3& p) const;
  /// The same where the sensor stands. Only in scenes with priorities.
  const MediumStack& sensor_media() const { return sensor_media_; }
  const Medium* world_medium() const { return parts_.world_medium.get(); }
  /// All media of the scene, each once.
  const std::vector<Surroundings>& media() const { return media_; }
  /// That with the longest mean free path; null without media.
  const Medium* thinnest_medium() const;
  /// Some medium has no closed boundary around it (Surroundings::bounded), and may reach to the end of the world.
  bool has_unbounded_media() const;
  /// What is known about the space that a medium of this scene fills.
  const Surroundings& surroundings(const Medium* medium) const;

  /// No straight line joins a place in the one medium (null: vacuum) with a place in the other.
  bool separates(const Medium* a, const Medium* b) const {
    return a != b && ((a && surroundings(a).sealed) || (b && surroundings(b).sealed));
  }

  /// Some surface lets light pass straight on, or may (see MediumStack::hides): shadow rays must walk from surface to
  /// surface.
  bool has_null_surfaces() const { return has_null_surfaces_; }

  /// Sphere around all shapes. Media that fill unbounded space end at kWorldScale times its radius, or at the sensor or
  /// the light that stands farthest away where that is more: no path begins outside of the world.
  const Vec3& center() const { return center_; }
  float radius() const { return radius_; }
  /// Distance along a ray that begins in the world to the world's end, where an unbounded medium stops.
  float distance_to_world_end(const Ray& ray) const;
  static constexpr float kWorldScale = 4;

 private:
  void choose_probabilities();
  void measure_world();
  void find_enclosures();
  void find_media();
  Surroundings survey(const Medium* medium) const;

  SceneParts parts_;
  std::unique_ptr<RayCaster> rays_;
  std::vector<const Emitter*> emitters_;
  std::vector<ChosenEnvironment> environments_;
  std::vector<size_t> object_emitter_index_;
  DiscreteDistribution emitter_distribution_;
  const Medium* sensor_medium_ = nullptr;
  std::vector<Surroundings> media_;
  bool has_null_surfaces_ = false, has_priorities_ = false;
  MediumStack sensor_media_;
  Vec3 center_;
  float radius_ = 1, world_radius_ = kWorldScale;
};

}  // namespace turbid
