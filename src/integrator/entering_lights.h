#pragma once
#include "integrator/place_tree.h"
#include "integrator/table_light.h"

namespace turbid {

struct EnteringLightsSettings {
  size_t lights = 0;  ///< about so many in a set; 0: by the size of the film
  int samples = 8;    ///< of these asked for at each place or way
};
/// The parameters of tables (table_parameters) and of these settings, and what the latter say.
std::vector<Parameter> entering_parameters();
EnteringLightsSettings entering_settings(const Properties& properties);

/// What walks that make EnteringLights share.
struct EnteringLightsPlan {
  const Scene& scene;
  const PathSettings& path;  ///< of the picture; light walks on whatever orders count
  const TableLight& table;
  uint64_t seed;
};

/// Light of many paths that has entered media with tables: the tables' sources for a whole picture, shared by all its
/// pixels. A walk from the sensor asks some of them, chosen by about what each should bring. Immutable, shared between
/// threads.
class EnteringLights {
 public:
  /// Traces `paths` light paths; `set` tells one set from another. The lights come in the order of the paths, whatever
  /// the threads do.
  EnteringLights(const EnteringLightsPlan& plan, size_t paths, uint64_t set, SampleCounters& counters);

  size_t size() const;

  /// The table's light along a way of the sensor's walk, of finite length up to the next surface, `state` at its
  /// beginning; black unless it has entered a medium with a table unscattered. Asks `count` lights.
  Spectrum along(const Ray& way, const Medium& medium, const PathState& state, int count, Rng& rng) const;
  /// All that it brings to a collision, the first one of a visit.
  LightByOrder at_collision(const CollisionEvent& event, const PathState& state, int count, Rng& rng) const;

 private:
  struct Group {
    const HomogeneousMedium* medium;
    std::vector<EnteringLight> lights;
    PlaceTree tree;                   ///< of about where each has lost its direction
    LightBalance balance;             ///< of their light
    float free_path, transport_path;  ///< mean ones, of the channels' mean
    float decay;                      ///< 1/length, far away, of the channel that reaches farthest
    Group(const HomogeneousMedium* m, std::vector<EnteringLight> entered);
  };
  /// Of what leaves the medium, and of what the table says.
  LightBalance balance_light(const Scene& scene, const Medium& medium, std::span<const EnteringLightKeeper::Left> left,
                             uint64_t seed) const;
  const Group* find(const Medium& medium) const;
  const LightBalance& balance_of(const Medium& medium) const;
  template <class Bring>
  void ask(const Medium& medium, const Vec3& seen, int count, Rng& rng, const Bring& bring) const;

  const TableLight& table_;
  const PathSettings& path_;
  std::vector<Group> groups_;
};

/// How many light paths make about so many entering lights (0: four for each pixel, which all samples of a set share),
/// at least 32,000 where the tables' light is measured; found by a pilot that depends on the plan alone.
size_t paths_for_entering_lights(const EnteringLightsPlan& plan, size_t lights);

/// The sets of a render, one after the other: samples of all pixels share a set, named by seed and number.
class EnteringLightSets {
 public:
  static constexpr uint64_t kReuse = 16;  ///< samples
  static uint64_t set_of(uint64_t sample) { return sample / kReuse; }

  /// Makes the set of that sample of all pixels, unless it is there: about so many lights.
  void prepare(const EnteringLightsPlan& plan, size_t lights, uint64_t sample, SampleCounters& counters);
  /// Null before the first.
  const EnteringLights* current() const { return lights_.get(); }
  void clear() { lights_.reset(), paths_ = 0; }

 private:
  std::unique_ptr<const EnteringLights> lights_;
  uint64_t seed_ = 0, set_ = 0;
  size_t paths_ = 0;  ///< of each set, found for the seed
};

}  // namespace turbid
