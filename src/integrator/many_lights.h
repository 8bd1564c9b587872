#pragma once
#include "integrator/integrator_plugin.h"
#include "integrator/splatting_integrator.h"
#include "integrator/virtual_light_gatherer.h"
#include "manylight/importance_cache.h"

namespace turbid {

/// What `vpl` and `vrl` are told beside the common parameters.
struct ManyLightsSettings {
  enum class Sampler { kAll, kUniform, kPower, kUnshadowed, kImportanceCache, kLightTree };
  Sampler sampler = Sampler::kImportanceCache;
  bool rays = false;                          ///< ray lights instead of points where light collides
  size_t lights = 1000;                       ///< about so many in a set
  int reuse = 16;                             ///< samples of the pixels that share a set
  int light_samples = 8, direct_samples = 4;  ///< see ShadingPlan
  LineSettings lines;
  VolumePoints volume_points;
  CacheSettings caches;
  std::optional<RefractiveSettings> refraction;  ///< of single scattering; empty: by paths
  TableSettings table;
  EnteringLightsSettings entering;
};

/// Rendering by virtual point lights (Keller 1997) and ray lights (Novak et al. 2012): light paths leave lights where
/// they scatter, or could, and these shade what the sensor sees; lights seen there directly are asked for by next-event
/// estimation. Each set of lights makes an unbiased image; a render takes a new set after every `reuse` samples.
/// Chooses among lights by importance caching (S2) or in simpler ways.
///
/// What it cannot sample: beams and glowing media, delta lights seen in or through specular vertices next to what they
/// light. Unclamped, a point light next to what it shades has no variance.
class ManyLights : public SplattingIntegrator {
 public:
  ManyLights(const PathSettings& path, const ManyLightsSettings& own) : path_(path), own_(own) {}

  /// Nothing is splatted: no pilot finds the scale of splats.
  void prepare(const Scene& scene, uint64_t, const StopFlag&) override { prepare_workers(scene); }
  Counters counters() const override;
  PathSupport support() const override { return {.glowing_media = false}; }

 protected:
  std::unique_ptr<Worker> make_worker(const Scene& scene, uint64_t seed, SampleCounters& counters) const override;
  void prepare_workers(const Scene& scene) override;
  bool prepare_round(const Scene& scene, uint64_t seed, uint64_t index, int round, const StopFlag& stop) override;

 private:
  class Shader;
  std::unique_ptr<LightSampler> make_sampler(const Scene& scene, uint64_t seed, uint64_t set, const StopFlag& stop);
  std::unique_ptr<LightSampler> make_caches(const Scene& scene, uint64_t seed, uint64_t set, const StopFlag& stop);

  PathSettings path_;
  ManyLightsSettings own_;
  std::optional<LightSources> sources_;
  std::unique_ptr<const RefractiveScattering> scattering_;
  std::unique_ptr<const TableLight> table_;  ///< null: virtual lights make multiple scattering, too
  std::optional<ShadingPlan> plan_;

  // The set of lights that is in use.
  struct Set {
    uint64_t seed, number;
    VirtualLights lights;
    std::unique_ptr<LightSampler> sampler;     ///< null: all lights
    std::unique_ptr<EnteringLights> entering;  ///< where there is a table
  };
  std::optional<Set> set_;
  size_t paths_ = 0;           ///< of a set; found for the seed ...
  size_t entering_paths_ = 0;  ///< ... that make entering lights, too
  uint64_t paths_seed_ = 0;

  SampleCounters prepared_;
  uint64_t lights_made_ = 0, caches_made_ = 0, cache_connections_ = 0;
  double cache_seconds_ = 0;
};

/// Rows of the integrator table: `vpl`, `vrl`.
IntegratorPlugin vpl_row();
IntegratorPlugin vrl_row();

}  // namespace turbid
