#pragma once
#include <bitset>
#include <optional>

#include "integrator/entering_lights.h"
#include "integrator/integrator_plugin.h"
#include "integrator/splatting_integrator.h"
#include "photon/photon_gatherer.h"
#include "photon/photon_recorder.h"

namespace turbid {

/// What `upbp` and its presets are told beside the common parameters.
struct UpbpSettings {
  std::bitset<kTechniqueNames.size()> techniques;  ///< by Technique; none: a pilot chooses
  StrategyWeights::Heuristic heuristic = StrategyWeights::Heuristic::kBalance;
  float connections = 8;                        ///< BdptSettings::connections
  std::optional<float> radius, surface_radius;  ///< of kernels in media and on surfaces; empty: by the scene
  float pixels = 0.5f;                          ///< largest radius by the scene, in widths of what a pixel covers
  float keep = 2.0f / 3;                        ///< of radius_factor
  bool long_beams = false, long_flights = false;
  int light_paths = 1;              ///< per pixel of each image
  int beam_paths = 0;               ///< of these leave beams; 0: a pilot chooses with the techniques, else kBeamPaths
  size_t memory = size_t{1} << 30;  ///< for photons, bytes; about
  bool shows_techniques = false;
  std::optional<RefractiveSettings> refraction;  ///< of single scattering; empty: by these techniques, too
  TableSettings table;
  EnteringLightsSettings entering;

  static constexpr int kBeamPaths = 5000;
  bool uses(Technique technique) const { return techniques[static_cast<size_t>(technique)]; }
};

/// Unified points, beams and paths (Křivánek et al. 2014): bidirectional path tracing, photons merged at surfaces, and
/// in media points and beams of photons merged with points and flights of walks from the sensor, in any combination,
/// all weighed against each other by recursive sums (StrategySums). Every sample of the pixels is an image of its own,
/// with its own light paths and radii that shrink from one to the next: consistent, and biased at any time.
///
/// Without `bpt`, paths with no vertex to merge at are found by chance alone.
class Upbp : public SplattingIntegrator {
 public:
  Upbp(const PathSettings& path, const UpbpSettings& own) : path_(path), own_(own) {
    if (own.shows_techniques) show_techniques();
  }

  void prepare(const Scene& scene, uint64_t seed, const StopFlag& stop) override;

  /// What images are like that these settings make, from a sample of the pixels; for pilots, in the place of prepare().
  struct Observation {
    double variance = 0;  ///< of a pixel's value in one image, mean over pixels and channels
    double work = 0;      ///< of an image for each pixel, in casts, counted
  };
  Observation observe(const Scene& scene, uint64_t seed, const StopFlag& stop);

  /// What is used; after prepare() also what the pilot has chosen.
  const UpbpSettings& settings() const { return own_; }

  Counters counters() const override;
  PathSupport support() const override;

 protected:
  std::unique_ptr<Worker> make_worker(const Scene& scene, uint64_t seed, SampleCounters& counters) const override;
  void prepare_workers(const Scene& scene) override;
  bool splats() const override { return own_.uses(Technique::kJoin); }
  bool prepare_round(const Scene& scene, uint64_t seed, uint64_t index, int round, const StopFlag& stop) override;

 private:
  class Tracer;
  class PilotSink;
  /// Finds out how much memory the photons of a light path take.
  void weigh_paths(const Scene& scene);
  void trace_photons(const Scene& scene, uint64_t seed, uint64_t index, size_t paths, const StopFlag& stop);
  void set_radii(const Scene& scene, uint64_t index, size_t paths);
  /// As many as the memory holds.
  size_t path_count(const Scene& scene) const;
  size_t beam_path_count(size_t paths) const {
    return std::min(paths, static_cast<size_t>(own_.beam_paths > 0 ? own_.beam_paths : UpbpSettings::kBeamPaths));
  }

  PathSettings path_;
  UpbpSettings own_;
  std::optional<size_t> most_paths_;
  std::optional<LightSources> sources_;
  std::unique_ptr<const RefractiveScattering> scattering_;
  KernelRadii first_radii_;
  uint64_t pilot_seed_ = 0;
  double bytes_per_path_ = 0;
  bool finds_scale_ = false;  ///< of splats, which needs no photons

  std::unique_ptr<const TableLight> table_;  ///< null: techniques find multiple scattering, too
  EnteringLightSets entering_;

  // Of the image that is being made.
  PhotonSettings leaves_;
  std::optional<StrategyWeights> weights_;
  std::optional<PhotonGatherer> gatherer_;
  PhotonMap map_;

  mutable std::mutex counters_mutex_;
  mutable MergeCounters merges_;
  uint64_t points_ = 0, beams_ = 0;
};

/// Rows of the integrator table: `upbp`, and its presets `photonmapper`, `bre` and `beams`.
std::vector<IntegratorPlugin> upbp_rows();

}  // namespace turbid
