#include "integrator/upbp.h"

#include "core/parallel.h"
#include "integrator/bidirectional_worker.h"
#include "integrator/merging_subpath.h"
#include "photon/default_radii.h"

namespace turbid {
namespace {

constexpr size_t kGrain = 256;  ///< light paths per task
constexpr uint64_t kWeighingStream = 0x6d656dull;

}  // namespace

class Upbp::Tracer final : public SplattingIntegrator::Worker {
 public:
  Tracer(const Upbp& owner, const Scene& scene, uint64_t seed, SampleCounters& counters)
      : owner_(owner),
        worker_({scene, *owner.sources_, owner.path_, *owner.weights_, owner.own_.connections}, seed, counters,
                *owner.gatherer_, owner.own_.long_flights, work_) {}

  ~Tracer() override {
    const std::lock_guard lock(owner_.counters_mutex_);
    owner_.merges_.add(work_.counters);
  }

  float run(size_t pixel, uint64_t index, ContributionSink& sink) override { return worker_.run(pixel, index, sink); }

 private:
  const Upbp& owner_;
  MergeWork work_;
  BidirectionalWorker<MergingSubpath> worker_;
};

std::unique_ptr<SplattingIntegrator::Worker> Upbp::make_worker(const Scene& scene, uint64_t seed,
                                                               SampleCounters& counters) const {
  return std::make_unique<Tracer>(*this, scene, seed, counters);
}

PathSupport Upbp::support() const {
  const bool joins = own_.uses(Technique::kJoin);
  return {.specular_at_sensor = true, .specular_at_delta_light = true, .beams = true, .glowing_media = joins};
}

void Upbp::prepare(const Scene& scene, uint64_t seed, const StopFlag& stop) {
  pilot_seed_ = hash_counters(seed, kWeighingStream);
  finds_scale_ = true;
  SplattingIntegrator::prepare(scene, seed, stop);
  finds_scale_ = false;
}

void Upbp::prepare_workers(const Scene& scene) {
  sources_.emplace(scene, true);
  first_radius_ = own_.radius ? *own_.radius : default_media_radius(scene, own_.pixels);
  first_surface_radius_ = own_.surface_radius ? *own_.surface_radius : default_surface_radius(scene, own_.pixels);
  leaves_.collisions = own_.uses(Technique::kPointPoint) || own_.uses(Technique::kPointBeam);
  leaves_.beams = own_.uses(Technique::kBeamPoint) || own_.uses(Technique::kBeamBeam);
  leaves_.inhomogeneous = leaves_.collisions || leaves_.beams;
  leaves_.surfaces = own_.uses(Technique::kSurface);
  leaves_.long_beams = own_.long_beams;
  weigh_paths(scene);
}

size_t Upbp::path_count(const Scene& scene) const {
  const size_t wanted = pixel_count(scene.film()) * static_cast<size_t>(own_.light_paths);
  const double most = static_cast<double>(own_.memory) / std::max(bytes_per_path_, 1.0);
  return most < static_cast<double>(wanted) ? std::max<size_t>(static_cast<size_t>(most), 1) : wanted;
}

void Upbp::set_radii(const Scene& scene, uint64_t index, size_t paths) {
  const auto radius = [&](Technique technique, float first, int dimensions) {
    return own_.uses(technique) ? first * radius_factor(index, own_.keep, dimensions) : 0;
  };
  const KernelRadii radii{.surface = radius(Technique::kSurface, first_surface_radius_, 2),
                          .point_point = radius(Technique::kPointPoint, first_radius_, 3),
                          .point_beam = radius(Technique::kPointBeam, first_radius_, 2),
                          .beam_point = radius(Technique::kBeamPoint, first_radius_, 2),
                          .beam_beam = radius(Technique::kBeamBeam, first_radius_, 1)};
  const float inhomogeneous = leaves_.inhomogeneous ? first_radius_ * radius_factor(index, own_.keep, 3) : 0;
  const PhotonCounts counts{static_cast<double>(paths), static_cast<double>(beam_path_count(paths))};
  weights_.emplace(own_.heuristic, merging_by(radii, counts, inhomogeneous), own_.uses(Technique::kJoin));
  gatherer_.emplace(scene, path_, *weights_, radii, inhomogeneous, counts, map_);
}

void Upbp::weigh_paths(const Scene& scene) {
  constexpr size_t kPaths = 4096;
  set_radii(scene, 0, kPaths);
  map_.photons.clear();
  trace_photons(scene, pilot_seed_, 0, kPaths, StopFlag());
  bytes_per_path_ = static_cast<double>(map_.photons.bytes()) / kPaths;
}

bool Upbp::prepare_round(const Scene& scene, uint64_t seed, uint64_t index, int, const StopFlag& stop) {
  const size_t paths = path_count(scene);
  set_radii(scene, index, paths);
  map_.photons.clear();
  if (!finds_scale_ && (leaves_.surfaces || leaves_.inhomogeneous)) trace_photons(scene, seed, index, paths, stop);
  map_.index(first_radius_);
  points_ += map_.photons.collisions.size() + map_.photons.surfaces.size();
  beams_ += map_.photons.beams.size();
  return true;
}

void Upbp::trace_photons(const Scene& scene, uint64_t seed, uint64_t index, size_t paths, const StopFlag& stop) {
  const size_t with_beams = beam_path_count(paths);
  std::vector<Photons> parts((paths + kGrain - 1) / kGrain);
  parallel_for(parts.size(), [&](size_t task) {
    if (stop.requested()) return;
    SampleCounters counters;
    Sampler sampler(scene.sampler(), hash_counters(seed, kLightStream));
    PhotonRecorder recorder(scene, *weights_, leaves_, counters);
    LightWalk<PhotonRecorder> walk(scene, path_, sampler, counters, recorder);
    for (size_t path = task * kGrain; path < std::min(paths, (task + 1) * kGrain); ++path) {
      sampler.start(path, index);
      recorder.begin(path < with_beams, parts[task]);
      walk.run(*sources_);
    }
    const std::lock_guard lock(counters_mutex_);
    traced_.add(counters);
  });
  for (Photons& part : parts) map_.photons.append(std::move(part));
}

Counters Upbp::counters() const {
  Counters result = SplattingIntegrator::counters();
  const std::lock_guard lock(counters_mutex_);
  result["light_paths"] += traced_.light_paths;
  result["rays"] += traced_.rays;
  result["shadow_rays"] += traced_.shadow_rays;
  result["collisions"] += traced_.collisions;
  result["free_flights"] += traced_.free_flights;
  result["photons"] = points_;
  result["photon_beams"] = beams_;
  result["point_tests"] = merges_.point_tests;
  result["beam_tests"] = merges_.beam_tests;
  result["merges"] = merges_.merges;
  return result;
}

}  // namespace turbid
