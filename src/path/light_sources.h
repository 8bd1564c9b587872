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

/// The lights of a scene as sources of light paths: chosen by their power, and what they stand in. (Next-event
/// estimation asks what reaches one place instead: Scene::choose_emitter.) Immutable, shared between threads.
class LightSources {
 public:
  /// `sees_media` false: media are ignored.
  LightSources(const Scene& scene, bool sees_media);

  /// Chooses a light and a ray; takes three draws of the sampler always. Empty where no light is (a black place of a
  /// picture), which counts as a path that carries nothing.
  std::optional<Emission> sample(Sampler& sampler) const;
  bool empty() const { return sources_.empty(); }
  /// Probability of the light with this place in Scene::emitters.
  float prob(size_t emitter) const { return distribution_.prob(emitter); }

 private:
  struct Source {
    const Emitter* emitter;
    const Object* object;
    bool stays_in_one_place = false;  ///< a point: `medium` and `media` hold
    const Medium* medium = nullptr;
    MediumStack media = MediumStack();
  };
  /// Finds medium and media where a ray begins that no source knows beforehand.
  void find_medium(const Source& source, Emission& emission) const;
  /// The medium on the near side of the first boundary on the way from p to the sensor; without one it is the sensor's.
  /// So light paths and sensor paths agree about space that nothing encloses.
  const Medium* medium_towards_sensor(const Vec3& p) const;

  const Scene& scene_;
  bool sees_media_;
  std::vector<Source> sources_;
  DiscreteDistribution distribution_;
};

}  // namespace turbid
