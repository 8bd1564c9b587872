#include "integrator/many_lights.h"

#include <fmt/format.h>

#include <ctime>
#include <mutex>

#include "core/log.h"
#include "integrator/cache_placer.h"
#include "integrator/camera_sample.h"
#include "manylight/light_tree.h"

namespace turbid {
namespace {

/// Keep streams apart.
constexpr uint64_t kCacheStream = 0x6361636865ull, kScatteringStream = 0x73636174ull;

/// Virtual lights and the choice among them do not depend on which orders count.
PathSettings all_orders(PathSettings settings) {
  settings.min_scattering = 0;
  settings.max_scattering = PathSettings::kUnlimited;
  return without_visit_limit(settings);
}

bool scatters(const Scene& scene) {
  return std::any_of(scene.media().begin(), scene.media().end(),
                     [](const Surroundings& s) { return !s.medium->sigma_s().is_black(); });
}

/// Processor time of all threads.
double seconds_now() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

}  // namespace

/// One camera sample: a walk that passes through media, and one that scatters there.
class ManyLights::Shader final : public SplattingIntegrator::Worker {
 public:
  Shader(const ManyLights& owner, const Scene& scene, uint64_t seed, SampleCounters& counters)
      : owner_(owner),
        scene_(scene),
        sampler_(scene.sampler(), seed),
        scattering_sampler_(scene.sampler(), hash_counters(seed, kScatteringStream)),
        counters_(counters),
        chooser_(owner.set_->sampler ? owner.set_->sampler->make_chooser() : nullptr),
        passing_(ShadingRecorder::Kind::kPasses, *owner.plan_, owner.set_->lights, owner.set_->entering.get(),
                 chooser_.get(), sampler_, counters),
        scattering_(ShadingRecorder::Kind::kScatters, *owner.plan_, owner.set_->lights, owner.set_->entering.get(),
                    chooser_.get(), scattering_sampler_, counters),
        passing_walk_(scene, owner.path_, sampler_, counters, passing_),
        scattering_walk_(scene, owner.path_, scattering_sampler_, counters, scattering_),
        has_media_(scatters(scene)) {}

  float run(size_t pixel, uint64_t index, ContributionSink& sink) override {
    const auto width = static_cast<size_t>(scene_.film().image_size().x);
    const Vec2i in_crop(static_cast<int>(pixel % width), static_cast<int>(pixel / width));
    const SensorRay camera = start_camera_sample(scene_, in_crop + scene_.film().crop_offset, index, sampler_);
    ++counters_.camera_samples;
    passing_.begin();
    float alpha = passing_walk_.run(camera);
    gather(passing_, sink);
    if (has_media_) {
      scattering_sampler_.start(pixel, index);
      scattering_.begin();
      alpha = scattering_walk_.run(camera);
      gather(scattering_, sink);
    }
    return alpha;
  }

 private:
  static void gather(const VirtualLightGatherer& found, ContributionSink& sink) {
    for (int order = 0; order < kOrderClasses; ++order)
      sink.gather({.value = found.found(order), .light_vertices = 1, .sensor_vertices = 1, .order = order});
  }

  const ManyLights& owner_;
  const Scene& scene_;
  Sampler sampler_, scattering_sampler_;
  SampleCounters& counters_;
  std::unique_ptr<LightSampler::Chooser> chooser_;
  VirtualLightGatherer passing_, scattering_;
  CameraWalk<VirtualLightGatherer> passing_walk_, scattering_walk_;
  bool has_media_;
};

std::unique_ptr<SplattingIntegrator::Worker> ManyLights::make_worker(const Scene& scene, uint64_t seed,
                                                                     SampleCounters& counters) const {
  return std::make_unique<Shader>(*this, scene, seed, counters);
}

void ManyLights::prepare_workers(const Scene& scene) {
  sources_.emplace(scene, true);
  own_.lines.max_depth = path_.max_depth;
  if (own_.refraction) scattering_ = std::make_unique<const RefractiveScattering>(scene, *own_.refraction);
  if (own_.table.source != TableSettings::Source::kNone) {
    TableSettings settings = own_.table;
    settings.behind_rough = false;
    table_ = std::make_unique<const TableLight>(scene, settings);
    table_->limit(path_);
  }
  plan_.emplace(ShadingPlan{scene, path_, own_.lines, own_.volume_points, own_.light_samples, own_.direct_samples,
                            own_.rays, scattering_.get(), own_.entering.samples});
  set_.reset();
  paths_ = 0;
}

bool ManyLights::prepare_round(const Scene& scene, uint64_t seed, uint64_t index, int, const StopFlag& stop) {
  const uint64_t number = index / static_cast<uint64_t>(own_.reuse);
  if (set_ && set_->seed == seed && set_->number == number) return true;
  const PathSettings light_path = all_orders(path_);
  VirtualLightPlan lights{scene, *sources_, light_path, seed, own_.rays};
  std::optional<EnteringLightsPlan> entering;
  if (table_) {
    lights.known_media = table_->media();
    lights.joined_visit_order = table_->from_order() - 3;
    entering.emplace(EnteringLightsPlan{scene, path_, *table_, seed});
  }
  if (paths_ == 0 || paths_seed_ != seed) {
    paths_ = paths_for_lights(lights, own_.lights);
    if (entering) entering_paths_ = paths_for_entering_lights(*entering, own_.entering.lights);
    paths_seed_ = seed;
  }
  set_.reset();
  set_.emplace(Set{seed, number, VirtualLights(lights, paths_, number, prepared_), nullptr, nullptr});
  if (entering) set_->entering = std::make_unique<EnteringLights>(*entering, entering_paths_, number, prepared_);
  lights_made_ += set_->lights.size();
  set_->sampler = make_sampler(scene, seed, number, stop);
  return true;
}

std::unique_ptr<LightSampler> ManyLights::make_sampler(const Scene& scene, uint64_t seed, uint64_t set,
                                                       const StopFlag& stop) {
  const VirtualLights& lights = set_->lights;
  switch (own_.sampler) {
    case ManyLightsSettings::Sampler::kAll:
      return nullptr;
    case ManyLightsSettings::Sampler::kUniform:
      return std::make_unique<UniformLightSampler>(lights.size());
    case ManyLightsSettings::Sampler::kPower:
      return std::make_unique<PowerLightSampler>(lights);
    case ManyLightsSettings::Sampler::kUnshadowed:
      return std::make_unique<UnshadowedLightSampler>(lights, plan_->lines);
    case ManyLightsSettings::Sampler::kLightTree:
      return std::make_unique<LightTree>(lights, plan_->lines);
    default:
      return make_caches(scene, seed, set, stop);
  }
}

std::unique_ptr<LightSampler> ManyLights::make_caches(const Scene& scene, uint64_t seed, uint64_t set,
                                                      const StopFlag& stop) {
  const double begin = seconds_now();
  CacheSettings caches = own_.caches;
  auto& [surfaces, collisions, ways] = caches.points;
  if (own_.rays) ways = std::exchange(collisions, 0);
  if (!scatters(scene)) surfaces += std::exchange(collisions, 0) + std::exchange(ways, 0);
  const CachePlacer placer(*plan_, set_->lights, hash_counters(seed, kCacheStream, set));
  std::mutex mutex;
  // A right angle between normals counts as much as a fiftieth of the scene, one between ways as much as all of it.
  const std::array<float, kPlaceKinds> spacing = {0.02f * scene.radius(), 0, scene.radius()};
  const auto record = [&](PlaceKind kind, size_t number, std::span<float> weights) {
    if (stop.requested()) return ImportanceCache::Record{};
    SampleCounters counters;
    const auto point = placer.record(kind, number, weights, counters);
    const std::lock_guard lock(mutex);
    cache_connections_ += std::exchange(counters.connections, 0);
    prepared_.add(counters);
    return point;
  };
  auto result = std::make_unique<ImportanceCache>(caches, set_->lights.size(), spacing, record,
                                                  std::make_unique<NearLights>(set_->lights, plan_->lines));
  if (result->is_cut() && caches_made_ == 0)
    log_warning(fmt::format("{} cache points for {} lights fit into the memory they may take, fewer than asked for",
                            result->points(), set_->lights.size()));
  caches_made_ += result->points();
  cache_seconds_ += seconds_now() - begin;
  return result;
}

Counters ManyLights::counters() const {
  Counters result = SplattingIntegrator::counters();
  result["light_paths"] += prepared_.light_paths;
  result["rays"] += prepared_.rays;
  result["shadow_rays"] += prepared_.shadow_rays;
  result["collisions"] += prepared_.collisions;
  result["free_flights"] += prepared_.free_flights;
  result["virtual_lights"] = lights_made_;
  if (own_.sampler == ManyLightsSettings::Sampler::kImportanceCache) {
    result["cache_points"] = caches_made_;
    result["cache_connections"] = cache_connections_;
    result["cache_milliseconds"] = static_cast<uint64_t>(1000 * cache_seconds_);
  }
  return result;
}

}  // namespace turbid
