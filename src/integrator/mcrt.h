#pragma once
#include <optional>

#include "gathering/light_depositor.h"
#include "integrator/integrator_plugin.h"
#include "integrator/splatting_integrator.h"

namespace turbid {

/// What `mcrt` is told beside the common parameters.
struct McrtSettings {
  GatherSettings gather;
  bool chooses_q = false;           ///< by a pilot, see GatherPilot
  std::optional<float> radius;      ///< of the first image, scene units; empty: in pixels
  float pixels = 1;                 ///< radius as a multiple of what a pixel covers at the distance
  float disk_scale = 3;             ///< radii of disks over those of volumes
  float keep = 2.0f / 3;            ///< of radius_factor
  int light_paths = 1;              ///< per pixel of each image
  size_t memory = size_t{1} << 30;  ///< for volumes, disks and their index, bytes; about
};

/// Bidirectional Monte Carlo ray tracing with gathering volumes (S5): walks from the sensor leave spheres or cylinders
/// in media and disks on rough surfaces, then walks from the lights fill them. Every sample of the pixels is an image
/// of its own, with its own walks and with radii that shrink from one to the next: consistent, and biased at any time.
///
/// What it cannot sample: the light of glowing media.
class Mcrt : public SplattingIntegrator {
 public:
  Mcrt(const PathSettings& path, const McrtSettings& own) : path_(path), own_(own) {}

  void prepare(const Scene& scene, uint64_t seed, const StopFlag& stop) override;
  Counters counters() const override;
  PathSupport support() const override {
    return {.specular_at_sensor = true,
            .specular_at_delta_light = own_.gather.disks,
            .specular_at_both_ends = own_.gather.disks,
            .beams = own_.gather.disks,
            .glowing_media = false};
  }

  /// The share q that is used; after prepare() that of the pilot.
  float q() const { return own_.gather.q; }

 protected:
  std::unique_ptr<Worker> make_worker(const Scene& scene, uint64_t seed, SampleCounters& counters) const override;
  void prepare_workers(const Scene& scene) override;
  bool prepare_round(const Scene& scene, uint64_t seed, uint64_t index, int round, const StopFlag& stop) override;

 private:
  class LightTracer;
  /// Walks from the sensor through pixels [from, to), in order.
  void gather_pixels(const Scene& scene, uint64_t seed, uint64_t index, size_t from, size_t to, const StopFlag& stop);
  void set_radii(uint64_t index);

  PathSettings path_;
  McrtSettings own_;
  std::optional<LightSources> sources_;
  std::optional<GatherPlan> plan_;
  GatherRadius first_radius_;
  size_t paths_per_pixel_ = 1;

  // Of the image that is being made.
  GatherStore store_;
  bool last_round_ = true;
  size_t next_pixel_ = 0;
  std::vector<FoundLight> light_;   ///< in the order of pixels
  std::vector<size_t> light_ends_;  ///< of each pixel's part of it
  std::vector<float> alpha_;

  mutable std::mutex counters_mutex_;
  mutable DepositCounters deposits_;
  uint64_t volumes_ = 0, disks_ = 0;
};

/// Row of the integrator table: `mcrt`.
IntegratorPlugin mcrt_row();

}  // namespace turbid
