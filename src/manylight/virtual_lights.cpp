#include "manylight/virtual_lights.h"

#include <mutex>

#include "core/parallel.h"
#include "manylight/k_d_tree.h"
#include "path/walk.h"

namespace turbid {
namespace {

constexpr size_t kGrain = 64;  ///< paths per task
/// Keeps the streams of virtual lights and of the pilot apart from all others.
constexpr uint64_t kLightsStream = 0x76706cull, kRouletteStream = 0x726f756cull, kPilotSet = ~uint64_t{0};

/// What light paths leave.
struct Left {
  std::vector<Vertex> vertices;
  std::vector<CollisionSegment> rays;

  void append(Left& other) {
    vertices.insert(vertices.end(), other.vertices.begin(), other.vertices.end());
    rays.insert(rays.end(), other.rays.begin(), other.rays.end());
    other = {};
  }
};

class LightKeeper : public WalkRecorder {
 public:
  LightKeeper(const VirtualLightPlan& plan, Left& left, float scale)
      : left_(left),
        start_scale_(scale),
        scale_(scale),
        rays_(plan.rays),
        joined_visit_order_(plan.joined_visit_order),
        roulette_(plan.known_media) {}

  /// For a new walk, whose choices beside the path go by `name`.
  void begin(uint64_t name) {
    roulette_.begin(Rng(name));
    rng_ = Rng(hash_counters(name));
    scale_ = start_scale_;
  }

  void on_segment(const Ray& way, const Medium& medium, const PathState& state, const Traveller::Leg&) {
    const HomogeneousMedium* homogeneous = medium.as_homogeneous();
    if (!rays_ || !homogeneous || medium.sigma_s().is_black() || state.throughput.is_black()) return;
    if (!(way.t_max > 0 && std::isfinite(way.t_max))) return;
    const bool for_surfaces = state.visit_order > joined_visit_order_ && roulette_.holds(&medium);
    if (for_surfaces && rng_.next_float() >= kShareForSurfaces) return;
    left_.rays.push_back(
        CollisionSegment::of_light(way, *homogeneous, state, for_surfaces ? scale_ / kShareForSurfaces : scale_));
  }
  void at_surface(const SurfaceEvent& event, const PathState& state, const Traveller& traveller) {
    if (event.object.bsdf->flags() & lobe::kSmooth && !state.throughput.is_black())
      left_.vertices.emplace_back(event, state, traveller.medium()).throughput *= scale_;
  }
  void at_collision(const CollisionEvent& event, const PathState& state, const Traveller&) {
    if (!rays_ || !event.medium.as_homogeneous()) left_.vertices.emplace_back(event, state).throughput *= scale_;
  }
  void left_collision(const CollisionEvent& event, float, const Vec3&, const PathState& state, const Traveller&) {
    roulette_.left_collision(event.medium, state);
    scale_ = start_scale_ * roulette_.scale();
  }
  bool goes_on() const { return roulette_.goes_on(); }

 private:
  static constexpr float kShareForSurfaces = 0.25f;  ///< of ray lights that light surfaces alone

  Left& left_;
  float start_scale_, scale_;  ///< 1 / paths; with the roulette's
  bool rays_;
  int joined_visit_order_;
  VisitRoulette roulette_;
  Rng rng_;
};

Left trace(const VirtualLightPlan& plan, size_t paths, uint64_t set, SampleCounters& counters) {
  std::vector<Left> parts((paths + kGrain - 1) / kGrain);
  std::mutex mutex;
  parallel_for(parts.size(), [&](size_t task) {
    SampleCounters own;
    Sampler sampler(plan.scene.sampler(), hash_counters(plan.seed, kLightsStream));
    LightKeeper keeper(plan, parts[task], 1 / static_cast<float>(paths));
    LightWalk<LightKeeper> walk(plan.scene, plan.path, sampler, own, keeper);
    for (size_t path = task * kGrain; path < std::min(paths, (task + 1) * kGrain); ++path) {
      sampler.start(path, set);
      keeper.begin(hash_counters(plan.seed, kRouletteStream, path, set));
      walk.run(plan.sources);
    }
    const std::lock_guard lock(mutex);
    counters.add(own);
  });
  Left all;
  for (Left& part : parts) all.append(part);
  return all;
}

/// Puts side by side what stands side by side.
template <class Thing, class Where>
std::vector<Thing> ordered_by_place(std::vector<Thing> things, const Where& where) {
  std::vector<KdTree<3>::Point> places;
  std::vector<uint32_t> order;
  for (const Thing& thing : things) {
    const Vec3 p = where(thing);
    order.push_back(static_cast<uint32_t>(places.size()));
    places.push_back({p.x, p.y, p.z});
  }
  for_groups(places, std::span(order), 1, [](std::span<const uint32_t>) {});
  std::vector<Thing> result;
  result.reserve(things.size());
  for (const uint32_t i : order) result.push_back(std::move(things[i]));
  return result;
}

}  // namespace

VirtualLights::VirtualLights(const VirtualLightPlan& plan, size_t paths, uint64_t set, SampleCounters& counters) {
  Left left = trace(plan, paths, set, counters);
  vertices_ = ordered_by_place(std::move(left.vertices), [](const Vertex& vertex) { return vertex.position; });
  rays_ = ordered_by_place(std::move(left.rays),
                           [](const CollisionSegment& ray) { return ray.way().at(ray.way().t_max / 2); });
  points_.reserve(vertices_.size());
  for (const Vertex& vertex : vertices_) points_.emplace_back(vertex, TransportMode::kImportance);
}

size_t paths_for_lights(const VirtualLightPlan& plan, size_t lights) {
  constexpr size_t kPilotPaths = 4096;
  constexpr double kLeastPerPath = 0.01;
  SampleCounters counters;
  const Left left = trace(plan, kPilotPaths, kPilotSet, counters);
  const double per_path =
      static_cast<double>(left.vertices.size() + left.rays.size()) / static_cast<double>(kPilotPaths);
  const double paths = static_cast<double>(lights) / std::max(per_path, kLeastPerPath);
  return std::max<size_t>(1, static_cast<size_t>(std::lround(paths)));
}

}  // namespace turbid
