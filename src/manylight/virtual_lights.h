#pragma once
#include <vector>

#include "manylight/collision_segment.h"
#include "manylight/scatterer.h"
#include "path/light_sources.h"
#include "path/sample_counters.h"
#include "path/visit_roulette.h"

namespace turbid {

/// How virtual lights are made.
struct VirtualLightPlan {
  const Scene& scene;
  const LightSources& sources;
  const PathSettings& path;
  uint64_t seed;
  bool rays = false;  ///< ray lights stand for collisions in homogeneous media
  /// Where ways of the sensor are joined with few of the ray lights alone, for what comes after more collisions is
  /// known from elsewhere: walks that have scattered often there are thinned out, ...
  std::vector<const Medium*> known_media = {};
  int joined_visit_order = 0;  ///< ... and ray lights after more collisions in the visit than this
};

/// Virtual point lights: the vertices of light paths where something scatters, collisions and surfaces with a smooth
/// lobe alike. Each knows where its light comes from, so that anisotropic and glossy lobes keep their shape. Their sum
/// stands for all light that scatters once or more before it comes to the place that is shaded.
///
/// With ray lights, what light paths fly through homogeneous media takes the place of the collisions there: a ray light
/// is all collisions that could have been on it. Numbers of lights count points first, then rays. A ray light whose
/// order() is 1 has not scattered in media before: who knows of a better way for what comes after can take it from
/// there.
class VirtualLights {
 public:
  /// Traces `paths` light paths; `set` tells one set of lights from another. The order of the lights
  /// depends on nothing else; neighbours in it stand near each other, so that samples which are stratified over it are
  /// so in space, and lines to lights in turn run side by side.
  VirtualLights(const VirtualLightPlan& plan, size_t paths, uint64_t set, SampleCounters& counters);
  VirtualLights(VirtualLights&&) = default;
  VirtualLights& operator=(VirtualLights&&) = default;

  const std::vector<Scatterer>& points() const { return points_; }
  const std::vector<CollisionSegment>& rays() const { return rays_; }
  size_t size() const { return points_.size() + rays_.size(); }
  bool empty() const { return size() == 0; }
  /// The light will be asked soon.
  void prefetch(size_t light) const {
    const void* const at = light < points_.size() ? static_cast<const void*>(&points_[light])
                                                  : static_cast<const void*>(&rays_[light - points_.size()]);
    __builtin_prefetch(at);
    __builtin_prefetch(static_cast<const char*>(at) + 64);
  }

 private:
  std::vector<Vertex> vertices_;
  std::vector<Scatterer> points_;
  std::vector<CollisionSegment> rays_;
};

/// How many light paths make about so many virtual lights; found by a pilot that depends on the plan alone. The number
/// of paths must not depend on the lights that they make, or brighter sets would weigh more.
size_t paths_for_lights(const VirtualLightPlan& plan, size_t lights);

}  // namespace turbid
