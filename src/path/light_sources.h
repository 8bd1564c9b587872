#pragma once
#include <optional>
#include <vector>

#include "core/distribution.h"
#include "scene/scene.h"

namespace turbid {

/// A ray of light that sets out.
struct Emission {
  const Emitter* emitter;
  size_t index;          ///< of the emitter in Scene::emitters
  const Object* object;  ///< that shines; null for lights without a surface
  EmissionSample ray;
  float prob;            ///< of this emitter among all
  Spectrum throughput;   ///< flux: ray.weight / prob
  const Medium* medium;  ///< where it begins; null: vacuum
  MediumStack media;     ///< the same in scenes with priorities
};

/// A place that light is wanted in.
struct Ball {
  Vec3 center;
  float radius;
};

/// The lights of a scene as sources of light paths: chosen by their power, and what they stand in. (Next-event
/// estimation asks what reaches one place instead: Scene::choose_emitter.)
///
/// Where targets are given half of the rays are aimed at them: light and target are chosen by about how much the one
/// sends through the other, then the ray so that it meets the target, were there nothing between. Both kinds weigh by
/// the density of either (balance heuristic with one sample), so that a ray carries never more than twice what it would
/// without targets. Immutable, shared between threads.
class LightSources {
 public:
  /// `sees_media` false: media are ignored.
  LightSources(const Scene& scene, bool sees_media, std::vector<Ball> targets = {});

  /// Chooses a light and a ray; takes three draws of the sampler always. Empty where no light is (a black place of a
  /// picture), which counts as a path that carries nothing.
  std::optional<Emission> sample(Sampler& sampler) const;
  bool empty() const { return sources_.empty(); }
  /// Probability of the light with this place in Scene::emitters, without targets.
  float prob(size_t emitter) const { return distribution_.prob(emitter); }

 private:
  struct Source {
    const Emitter* emitter;
    const Object* object;
    bool stays_in_one_place = false;  ///< a point: `medium` and `media` hold
    const Medium* medium = nullptr;
    MediumStack media = MediumStack();
  };
  /// A light that is aimed at a target.
  struct Aim {
    size_t source, target;
  };
  void find_aims();
  /// In the place of the ray that the light would send by itself: one that meets the target. Empty where none does.
  std::optional<EmissionSample> aim(const Source& source, const Ball& target, const EmissionSample& ray,
                                    const Vec2& u) const;
  /// What the ray carries over the density of all ways to choose it.
  Spectrum weigh(size_t source, const EmissionSample& ray) const;
  /// Finds medium and media where a ray begins that no source knows beforehand.
  void find_medium(const Source& source, Emission& emission) const;
  /// The medium on the near side of the first boundary on the way from p to the sensor; without one it is the sensor's.
  /// So light paths and sensor paths agree about space that nothing encloses.
  const Medium* medium_towards_sensor(const Vec3& p) const;

  const Scene& scene_;
  bool sees_media_;
  std::vector<Source> sources_;
  DiscreteDistribution distribution_;
  std::vector<Ball> targets_;
  std::vector<Aim> aims_;  ///< empty: no ray is aimed
  DiscreteDistribution aim_distribution_;
};

}  // namespace turbid
