#include "integrator/entering_lights.h"

#include <mutex>

#include "core/parallel.h"
#include "integrator/boundary_views.h"

namespace turbid {
namespace {

constexpr size_t kGrain = 64;  ///< paths per task
/// Keep streams apart.
constexpr uint64_t kEnteringStream = 0x656e746572ull, kRouletteStream = 0x726f756cull, kViewStream = 0x76696577ull,
                   kPilotSet = ~uint64_t{0};
/// Which orders count is for what the light brings to say.
PathSettings all_orders(PathSettings settings) {
  settings.min_scattering = 0;
  settings.max_scattering = PathSettings::kUnlimited;
  return without_visit_limit(settings);
}

struct Traced {
  std::vector<EnteringLight> lights;
  std::vector<EnteringLightKeeper::Left> left;
};

Traced trace(const EnteringLightsPlan& plan, size_t paths, uint64_t set, SampleCounters& counters) {
  const PathSettings settings = all_orders(plan.path);
  std::vector<Traced> parts((paths + kGrain - 1) / kGrain);
  std::mutex mutex;
  parallel_for(parts.size(), [&](size_t task) {
    SampleCounters own;
    Sampler sampler(plan.scene.sampler(), hash_counters(plan.seed, kEnteringStream));
    EnteringLightKeeper keeper(plan.scene, plan.table, own, 1 / static_cast<float>(paths));
    LightWalk<EnteringLightKeeper> walk(plan.scene, settings, sampler, own, keeper);
    for (size_t path = task * kGrain; path < std::min(paths, (task + 1) * kGrain); ++path) {
      sampler.start(path, set);
      keeper.begin(Rng(hash_counters(plan.seed, kRouletteStream, path, set)));
      walk.run(plan.table.sources());
    }
    parts[task] = {keeper.entered(), keeper.left()};
    const std::lock_guard lock(mutex);
    counters.add(own);
  });
  Traced all;
  for (const Traced& part : parts) {
    all.lights.insert(all.lights.end(), part.lights.begin(), part.lights.end());
    all.left.insert(all.left.end(), part.left.begin(), part.left.end());
  }
  return all;
}

}  // namespace

std::vector<Parameter> entering_parameters() {
  std::vector<Parameter> parameters = table_parameters();
  parameters.push_back({"entering_lights",
                        ParameterType::kInteger,
                        "0",
                        "about so many ways of light in a set that tables begin with; 0: four for each pixel",
                        {.min = 0}});
  parameters.push_back({"table_samples", ParameterType::kInteger, "8",
                        "of these asked for at each place, or on each way, of the sensor's walks", kAtLeastOne});
  return parameters;
}

EnteringLightsSettings entering_settings(const Properties& properties) {
  const auto count = [&](const char* name) { return std::min<int64_t>(properties.integer(name), int64_t{1} << 30); };
  return {static_cast<size_t>(count("entering_lights")), static_cast<int>(count("table_samples"))};
}

EnteringLights::Group::Group(const HomogeneousMedium* m, std::vector<EnteringLight> entered)
    : medium(m), lights(std::move(entered)) {
  const float g = m->phase().mean_cosine(), sigma_t = m->sigma_t().mean();
  const float albedo = m->sigma_s().mean() / sigma_t;
  free_path = 1 / sigma_t;
  transport_path = 1 / (sigma_t * (1 - g * albedo));
  decay = kInfinity;
  for (int c = 0; c < kChannels; ++c) {
    const float a = m->albedo()[c];
    if (a > 0) decay = std::min(decay, m->sigma_t()[c] * std::sqrt(3 * (1 - a) * (1 - g * a)));
  }
  std::vector<Vec3> places;
  std::vector<float> strengths;
  for (const EnteringLight& light : lights) {
    places.push_back(light.way.origin + light.way.direction * std::min(light.way.length, transport_path));
    // Of a short way most comes out again unscattered.
    strengths.push_back(light.flux.mean() * -std::expm1(-light.way.length / free_path));
  }
  tree = PlaceTree(places, strengths);
}

EnteringLights::EnteringLights(const EnteringLightsPlan& plan, size_t paths, uint64_t set, SampleCounters& counters)
    : table_(plan.table), path_(plan.path) {
  const Traced all = trace(plan, paths, set, counters);
  for (const Medium* medium : table_.media()) {
    std::vector<EnteringLight> own;
    std::copy_if(all.lights.begin(), all.lights.end(), std::back_inserter(own),
                 [&](const EnteringLight& light) { return light.medium == medium; });
    groups_.emplace_back(medium->as_homogeneous(), std::move(own));
    if (!table_.measured()) continue;
    groups_.back().balance = balance_light(plan.scene, *medium, all.left, hash_counters(plan.seed, kViewStream, set));
  }
}

LightBalance EnteringLights::balance_light(const Scene& scene, const Medium& medium,
                                           std::span<const EnteringLightKeeper::Left> left, uint64_t seed) const {
  constexpr size_t kLeavingPerCell = 64;
  Bounds3 box;
  std::set<SurfaceSide> sides;
  std::vector<LeavingPower> leaving;
  for (const EnteringLightKeeper::Left& one : left) {
    if (one.medium != &medium) continue;
    box.extendBy(one.at);
    sides.insert(one.side);
    leaving.push_back(one.light);
  }
  const Group* group = find(medium);
  if (leaving.empty() || !(max_component(box.size()) > 0)) return {};
  const Ball ball{box.center(), length(box.size()) / 2};
  const auto prediction = [&](const CollisionEvent& event, const PathState& state, Rng& rng) {
    constexpr int kAsked = 4;
    Spectrum sum(0.0f);
    ask(medium, event.position, kAsked, rng, [&](const EnteringLight& light, float scale) {
      sum += table_.looked_up(light, {}, event, state, rng) * scale;
    });
    return sum;
  };
  return LightBalance(leaving, look_into(scene, medium, sides, ball, group->lights.size(), seed, prediction),
                      leaving.size() / kLeavingPerCell);
}

size_t EnteringLights::size() const {
  size_t sum = 0;
  for (const Group& group : groups_) sum += group.lights.size();
  return sum;
}

const EnteringLights::Group* EnteringLights::find(const Medium& medium) const {
  for (const Group& group : groups_)
    if (group.medium == &medium) return &group;
  return nullptr;
}

const LightBalance& EnteringLights::balance_of(const Medium& medium) const {
  static const LightBalance kNone;
  const Group* group = find(medium);
  return group ? group->balance : kNone;
}

/// Lights are drawn with probabilities in proportion to about what diffusion would bring from where each has lost its
/// direction to `seen`: bring(light, 1 / expected number of draws).
template <class Bring>
void EnteringLights::ask(const Medium& medium, const Vec3& seen, int count, Rng& rng, const Bring& bring) const {
  const Group* found = find(medium);
  if (!found) return;
  const Group& group = *found;
  const auto falloff = [&](float distance2) {
    const float distance = std::sqrt(distance2), x = group.decay * distance;
    return std::exp(-x) / (distance + group.transport_path);
  };
  group.tree.draw(seen, count, rng.next_double(), falloff,
                  [&](uint32_t i, double expected) { bring(group.lights[i], static_cast<float>(1 / expected)); });
}

Spectrum EnteringLights::along(const Ray& way, const Medium& medium, const PathState& state, int count,
                               Rng& rng) const {
  Spectrum sum(0.0f);
  if (state.visit_order > 0 || state.throughput.is_black() || !table_.holds(&medium) || !(way.t_max > 0)) return sum;
  const float free_path = 1 / medium.sigma_t().mean();
  const Vec3 seen = way.at(std::min(way.t_max / 2, free_path));
  const auto boundaries = table_.boundaries_around(seen, way.direction, medium);
  ask(medium, seen, count, rng, [&](const EnteringLight& light, float scale) {
    sum += table_.along(light, boundaries, way, state, path_, balance_of(medium), rng) * scale;
  });
  return sum;
}

LightByOrder EnteringLights::at_collision(const CollisionEvent& event, const PathState& state, int count,
                                          Rng& rng) const {
  LightByOrder sum;
  if (state.visit_order != 1 || state.throughput.is_black() || !table_.holds(&event.medium)) return sum;
  const auto boundaries = table_.boundaries_around(event.position, event.direction, event.medium);
  const Spectrum balance = balance_of(event.medium).at(event.position, -event.direction);
  ask(event.medium, event.position, count, rng, [&](const EnteringLight& light, float scale) {
    table_.at_collision(light, boundaries, event, state, path_, balance, scale, rng, sum);
  });
  return sum;
}

size_t paths_for_entering_lights(const EnteringLightsPlan& plan, size_t lights) {
  constexpr size_t kPilotPaths = 4096;
  constexpr double kLeastPerPath = 0.001;
  // Small pictures see as much of a medium as large ones; beyond the largest number noise is not the sets'.
  constexpr size_t kFewest = 8000, kMost = 400'000;
  if (lights == 0) lights = std::clamp(4 * pixel_count(plan.scene.film()), kFewest, kMost);
  // A ratio of few samples is off.
  constexpr size_t kFewestMeasured = 32'000;
  if (plan.table.measured()) lights = std::max(lights, kFewestMeasured);
  SampleCounters counters;
  const double per_path = static_cast<double>(trace(plan, kPilotPaths, kPilotSet, counters).lights.size()) /
                          static_cast<double>(kPilotPaths);
  const double paths = static_cast<double>(lights) / std::max(per_path, kLeastPerPath);
  return std::max<size_t>(1, static_cast<size_t>(std::lround(paths)));
}

void EnteringLightSets::prepare(const EnteringLightsPlan& plan, size_t lights, uint64_t sample,
                                SampleCounters& counters) {
  const uint64_t set = set_of(sample);
  if (lights_ && seed_ == plan.seed && set_ == set) return;
  if (paths_ == 0 || seed_ != plan.seed) paths_ = paths_for_entering_lights(plan, lights);
  lights_ = std::make_unique<const EnteringLights>(plan, paths_, set, counters);
  seed_ = plan.seed;
  set_ = set;
}

}  // namespace turbid
