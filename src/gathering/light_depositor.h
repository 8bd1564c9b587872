#pragma once
#include "gathering/gather_kernels.h"
#include "gathering/sensor_gatherer.h"
#include "gathering/volume_index.h"

namespace turbid {

/// What one round of walks from the sensor has left, made searchable.
class GatherStore {
 public:
  /// Walks from the sensor leave their things here ...
  Gathering found;
  /// ... and when all have, they are indexed.
  void index() {
    volumes_.build(found.volumes.size(), [this](size_t i) { return found.volumes[i].bounds(); });
    disks_.build(found.disks.size(), [this](size_t i) { return found.disks[i].bounds(); });
  }
  const VolumeIndex& volumes() const { return volumes_; }
  const VolumeIndex& disks() const { return disks_; }

 private:
  VolumeIndex volumes_, disks_;
};

/// How much work the deposits were.
struct DepositCounters {
  uint64_t segments = 0;  ///< flights that looked for volumes
  uint64_t tests = 0;     ///< of volumes whose box was touched
  uint64_t deposits = 0;

  void add(const DepositCounters& other) {
    segments += other.segments;
    tests += other.tests;
    deposits += other.deposits;
  }
};

/// Recorder of walks from lights: what flies or collides in a volume, or arrives in a disk, is added to its pixel.
class LightDepositor : public WalkRecorder {
 public:
  /// `paths`: how many light paths make one image.
  LightDepositor(const GatherPlan& plan, const GatherStore& store, double paths, const Sampler& sampler,
                 SampleCounters& counters, DepositCounters& deposits)
      : plan_(plan),
        store_(store),
        inverse_paths_(static_cast<float>(1 / paths)),
        sampler_(sampler),
        counters_(counters),
        deposits_(deposits) {}

  void begin(ContributionSink& sink) { sink_ = &sink; }

  void at_emitter(const Emission& emission, const Traveller&) {
    aimed_at_ = emission.emitter->can_be_aimed_at();
    rough_ = 0;
  }
  void on_segment(const Ray& way, const Medium& medium, const PathState& state, const Traveller::Leg& leg);
  void at_surface(const SurfaceEvent& event, const PathState& state, const Traveller& traveller);
  void left_surface(const SurfaceEvent&, const BsdfSample& sample, const Vec3&, const PathState&, const Traveller&) {
    if (!(sample.flags & lobe::kDelta)) ++rough_;
  }
  /// Nothing takes light that rough surfaces have scattered, unless volumes or disks do.
  bool goes_on() const { return rough_ == 0 || plan_.gather.disks || plan_.gather.surface_light_in_volumes; }

 private:
  /// Is this the place where such light is taken, and does the path count?
  bool takes(const GatherVolume& volume, const Medium& medium, const PathState& state) const;
  void fly_through(const LightSegment& segment, const HomogeneousMedium& medium, const PathState& state);
  void collide(const Vec3& p, const Vec3& direction, const Medium& medium, const Spectrum& scattered,
               const PathState& state);
  void deposit(uint32_t pixel, const Spectrum& value, int light_vertices, int sensor_vertices, int order);
  void deposit(const GatherVolume& volume, const Spectrum& value, const PathState& state) {
    deposit(volume.pixel, value, state.depth + 1, volume.depth + 1, state.order + volume.order);
  }

  const GatherPlan& plan_;
  const GatherStore& store_;
  float inverse_paths_;
  const Sampler& sampler_;
  SampleCounters& counters_;
  DepositCounters& deposits_;
  ContributionSink* sink_ = nullptr;
  bool aimed_at_ = true;  ///< the light can be asked for: what it sends straight to surfaces is
  int rough_ = 0;         ///< scatterings by rough surfaces
};

}  // namespace turbid
