#include "integrator/upbp.h"

#include "core/parallel.h"
#include "integrator/bidirectional_worker.h"
#include "integrator/gather_pilot.h"
#include "integrator/merging_subpath.h"
#include "integrator/technique_pilot.h"
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
        worker_({scene, *owner.sources_, owner.path_, *owner.weights_, owner.own_.connections, owner.scattering_.get()},
                seed, counters, *owner.gatherer_, owner.own_.long_flights, owner.entering_.current(),
                owner.own_.entering.samples, work_) {}

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

/// (Not found, though: a delta light seen in nothing but specular vertices; without `bpt` and merges at surfaces, a
/// delta light on surfaces alone; between specular vertices, what has no merge there. What the pilot will choose is not
/// known before.)
PathSupport Upbp::support() const {
  auto merges = own_.techniques;
  merges.reset(static_cast<size_t>(Technique::kJoin));
  return {.specular_at_sensor = true,
          .specular_at_delta_light = true,
          .specular_at_both_ends = own_.techniques.none() || merges.any(),
          .beams = true,
          .glowing_media = own_.table.source == TableSettings::Source::kNone};
}

void Upbp::prepare(const Scene& scene, uint64_t seed, const StopFlag& stop) {
  if (own_.techniques.none()) own_ = choose_techniques(scene, path_, own_, seed, stop);
  pilot_seed_ = hash_counters(seed, kWeighingStream);
  finds_scale_ = true;
  SplattingIntegrator::prepare(scene, seed, stop);
  finds_scale_ = false;
}

void Upbp::prepare_workers(const Scene& scene) {
  sources_.emplace(scene, true);
  if (own_.refraction) scattering_ = std::make_unique<const RefractiveScattering>(scene, *own_.refraction);
  if (own_.table.source != TableSettings::Source::kNone) {
    table_ = std::make_unique<const TableLight>(scene, own_.table);
    table_->limit(path_);
    entering_.clear();
  }
  first_radii_ = own_.radius ? KernelRadii::in_media(*own_.radius) : default_media_radii(scene, own_.pixels);
  first_radii_.surface = own_.surface_radius ? *own_.surface_radius : default_surface_radius(scene, own_.pixels);
  leaves_.collisions = own_.uses(Technique::kPointPoint) || own_.uses(Technique::kPointBeam);
  leaves_.beams = own_.uses(Technique::kBeamPoint) || own_.uses(Technique::kBeamBeam);
  leaves_.inhomogeneous = leaves_.collisions || leaves_.beams;
  leaves_.surfaces = own_.uses(Technique::kSurface);
  leaves_.long_beams = own_.long_beams;
  weigh_paths(scene);
}

size_t Upbp::path_count(const Scene& scene) const {
  const size_t all = pixel_count(scene.film()) * static_cast<size_t>(own_.light_paths);
  const size_t wanted = std::min(all, most_paths_.value_or(all));
  const double most = static_cast<double>(own_.memory) / std::max(bytes_per_path_, 1.0);
  return most < static_cast<double>(wanted) ? std::max<size_t>(static_cast<size_t>(most), 1) : wanted;
}

void Upbp::set_radii(const Scene& scene, uint64_t index, size_t paths) {
  const auto radius = [&](Technique technique, float first, int dimensions) {
    return own_.uses(technique) ? first * radius_factor(index, own_.keep, dimensions) : 0;
  };
  const float inhomogeneous = leaves_.inhomogeneous ? radius_factor(index, own_.keep, 3) : 0;
  const KernelRadii radii{.surface = radius(Technique::kSurface, first_radii_.surface, 2),
                          .point_point = radius(Technique::kPointPoint, first_radii_.point_point, 3),
                          .point_beam = radius(Technique::kPointBeam, first_radii_.point_beam, 2),
                          .beam_point = radius(Technique::kBeamPoint, first_radii_.beam_point, 2),
                          .beam_beam = radius(Technique::kBeamBeam, first_radii_.beam_beam, 1),
                          .inhomogeneous = first_radii_.inhomogeneous * inhomogeneous,
                          .dense_from = first_radii_.dense_from};
  const PhotonCounts counts{static_cast<double>(paths), static_cast<double>(beam_path_count(paths))};
  weights_.emplace(own_.heuristic, merging_by(radii, counts), own_.uses(Technique::kJoin));
  gatherer_.emplace(scene, path_, *weights_, radii, counts, map_);
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
  map_.index([&](const HomogeneousMedium& medium) { return gatherer_->beam_radius(medium); });
  if (table_ && !finds_scale_) {
    const EnteringLightsPlan plan{scene, path_, *table_, seed};
    SampleCounters counters;
    entering_.prepare(plan, own_.entering.lights, index, counters);
    add_counters(counters);
  }
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
    PhotonRecorder recorder(scene, *weights_, leaves_, scattering_.get(), counters);
    LightWalk<PhotonRecorder> walk(scene, path_, sampler, counters, recorder);
    for (size_t path = task * kGrain; path < std::min(paths, (task + 1) * kGrain); ++path) {
      sampler.start(path, index);
      recorder.begin(path < with_beams, parts[task]);
      walk.run(*sources_);
    }
    add_counters(counters);
  });
  for (Photons& part : parts) map_.photons.append(std::move(part));
}

// --- pilots ----------------------------------------------------------------------------------------------------------

/// Keeps what one pixel gathers, and the squares of splats: each is one of many that may reach a pixel, so that the sum
/// of their squares, over as many paths as there are pixels, is the mean variance that they bring.
class Upbp::PilotSink final : public ContributionSink {
 public:
  Spectrum gathered{0.0f};
  double splatted = 0;

  void gather(const Contribution& contribution) override {
    const Spectrum value = contribution.value * contribution.weight;
    if (value.is_finite()) gathered += value;
  }
  void splat(size_t, const Contribution& contribution) override {
    const Spectrum value = contribution.value * contribution.weight;
    if (value.is_finite()) splatted += static_cast<double>((value * value).mean());
  }
};

Upbp::Observation Upbp::observe(const Scene& scene, uint64_t seed, const StopFlag& stop) {
  constexpr size_t kPixels = 2048, kMostPaths = size_t{1} << 14;
  constexpr uint64_t kImages = 4;
  most_paths_ = kMostPaths;
  pilot_seed_ = seed;
  prepare_workers(scene);
  const Counters before = counters();
  const size_t all = pixel_count(scene.film()), pixels = std::min(all, kPixels);
  std::vector<double> sums(pixels * kChannels), squares(pixels * kChannels), splatted(pixels);
  double storing = 0;
  for (uint64_t index = 0; index < kImages && !stop.requested(); ++index) {
    const double work_before = work_of(counters());
    prepare_round(scene, seed, index, 0, stop);
    storing += work_of(counters()) - work_before;
    parallel_for((pixels + kGrain - 1) / kGrain, [&](size_t task) {
      SampleCounters counters;
      {
        const auto worker = make_worker(scene, seed, counters);
        for (size_t i = task * kGrain; i < std::min(pixels, (task + 1) * kGrain); ++i) {
          PilotSink sink;
          worker->run(i * all / pixels, index, sink);
          splatted[i] += sink.splatted;
          for (int c = 0; c < kChannels; ++c) {
            sums[i * kChannels + static_cast<size_t>(c)] += static_cast<double>(sink.gathered[c]);
            squares[i * kChannels + static_cast<size_t>(c)] += sqr(static_cast<double>(sink.gathered[c]));
          }
        }
      }
      add_counters(counters);
    });
  }
  Observation result;
  for (size_t k = 0; k < sums.size(); ++k)
    result.variance +=
        std::max(0.0, squares[k] - sqr(sums[k]) / kImages) / (kImages - 1) / static_cast<double>(sums.size());
  for (const double sum : splatted) result.variance += sum / static_cast<double>(kImages * pixels);
  const double gathered = work_of(counters()) - work_of(before) - storing;
  const double traced = static_cast<double>(std::min(kMostPaths, all));
  result.work = gathered / static_cast<double>(kImages * pixels) + storing / (kImages * traced);
  return result;
}

Counters Upbp::counters() const {
  Counters result = SplattingIntegrator::counters();
  const std::lock_guard lock(counters_mutex_);
  result["photons"] = points_;
  result["photon_beams"] = beams_;
  result["point_queries"] = merges_.point_queries;
  result["beam_queries"] = merges_.beam_queries;
  result["point_tests"] = merges_.point_tests;
  result["beam_tests"] = merges_.beam_tests;
  result["merges"] = merges_.merges;
  return result;
}

}  // namespace turbid
