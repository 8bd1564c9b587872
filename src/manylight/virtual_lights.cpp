#include "manylight/virtual_lights.h"

#include <mutex>

#include "core/parallel.h"
#include "path/walk.h"

namespace turbid {
namespace {

constexpr size_t kGrain = 64;  ///< paths per task
/// Keeps the streams of virtual lights and of the pilot apart from all others.
constexpr uint64_t kLightsStream = 0x76706cull, kPilotSet = ~uint64_t{0};

class VertexKeeper : public WalkRecorder {
 public:
  VertexKeeper(std::vector<Vertex>& vertices, float scale) : vertices_(vertices), scale_(scale) {}

  void at_surface(const SurfaceEvent& event, const PathState& state, const Traveller& traveller) {
    if (event.object.bsdf->flags() & lobe::kSmooth && !state.throughput.is_black())
      vertices_.emplace_back(event, state, traveller.medium()).throughput *= scale_;
  }
  void at_collision(const CollisionEvent& event, const PathState& state, const Traveller&) {
    vertices_.emplace_back(event, state).throughput *= scale_;
  }

 private:
  std::vector<Vertex>& vertices_;
  float scale_;  ///< 1 / paths
};

std::vector<Vertex> trace(const VirtualLightPlan& plan, size_t paths, uint64_t set, SampleCounters& counters) {
  std::vector<std::vector<Vertex>> parts((paths + kGrain - 1) / kGrain);
  std::mutex mutex;
  parallel_for(parts.size(), [&](size_t task) {
    SampleCounters own;
    Sampler sampler(plan.scene.sampler(), hash_counters(plan.seed, kLightsStream));
    VertexKeeper keeper(parts[task], 1 / static_cast<float>(paths));
    LightWalk<VertexKeeper> walk(plan.scene, plan.path, sampler, own, keeper);
    for (size_t path = task * kGrain; path < std::min(paths, (task + 1) * kGrain); ++path) {
      sampler.start(path, set);
      walk.run(plan.sources);
    }
    const std::lock_guard lock(mutex);
    counters.add(own);
  });
  size_t count = 0;
  for (const auto& part : parts) count += part.size();
  std::vector<Vertex> vertices;
  vertices.reserve(count);
  for (auto& part : parts) {
    vertices.insert(vertices.end(), part.begin(), part.end());
    part = {};
  }
  return vertices;
}

}  // namespace

VirtualLights::VirtualLights(const VirtualLightPlan& plan, size_t paths, uint64_t set, SampleCounters& counters)
    : vertices_(trace(plan, paths, set, counters)) {
  points_.reserve(vertices_.size());
  for (const Vertex& vertex : vertices_) points_.emplace_back(vertex, TransportMode::kImportance);
}

size_t paths_for_lights(const VirtualLightPlan& plan, size_t lights) {
  constexpr size_t kPilotPaths = 4096;
  constexpr double kLeastPerPath = 0.01;
  SampleCounters counters;
  const double per_path =
      static_cast<double>(trace(plan, kPilotPaths, kPilotSet, counters).size()) / static_cast<double>(kPilotPaths);
  const double paths = static_cast<double>(lights) / std::max(per_path, kLeastPerPath);
  return std::max<size_t>(1, static_cast<size_t>(std::lround(paths)));
}

}  // namespace turbid
