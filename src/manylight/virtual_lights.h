#pragma once
#include <vector>

#include "manylight/scatterer.h"
#include "path/light_sources.h"
#include "path/sample_counters.h"

namespace turbid {

/// How virtual lights are made.
struct VirtualLightPlan {
  const Scene& scene;
  const LightSources& sources;
  const PathSettings& path;
  uint64_t seed;
};

/// Virtual point lights: the vertices of light paths where something scatters, collisions and surfaces with a smooth
/// lobe alike. Each knows where its light comes from, so that anisotropic and glossy lobes keep their shape. Their sum
/// stands for all light that scatters once or more before it comes to the place that is shaded.
class VirtualLights {
 public:
  /// Traces `paths` light paths; `set` tells one set of lights from another. The lights come in the order of the paths,
  /// whatever the threads do.
  VirtualLights(const VirtualLightPlan& plan, size_t paths, uint64_t set, SampleCounters& counters);
  VirtualLights(VirtualLights&&) = default;
  VirtualLights& operator=(VirtualLights&&) = default;

  const std::vector<Scatterer>& points() const { return points_; }
  size_t size() const { return points_.size(); }
  bool empty() const { return points_.empty(); }

 private:
  std::vector<Vertex> vertices_;
  std::vector<Scatterer> points_;
};

/// How many light paths make about so many virtual lights; found by a pilot that depends on the plan alone. The number
/// of paths must not depend on the lights that they make, or brighter sets would weigh more.
size_t paths_for_lights(const VirtualLightPlan& plan, size_t lights);

}  // namespace turbid
