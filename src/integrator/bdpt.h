#pragma once
#include <optional>

#include "integrator/integrator_plugin.h"
#include "integrator/splatting_integrator.h"
#include "path/light_sources.h"
#include "path/strategy_sums.h"
#include "refraction/refractive_scattering.h"

namespace turbid {

struct BdptSettings {
  StrategyWeights::Heuristic heuristic = StrategyWeights::Heuristic::kPower;
  /// Of the lines that join the two subpaths into paths of one length about so many are tried, all of them where there
  /// are fewer: long subpaths have too many.
  float connections = 8;
  int shown_edges = 0;                           ///< see SplattingIntegrator::show_strategies
  std::optional<RefractiveSettings> refraction;  ///< of single scattering; empty: by paths, too
};

/// Bidirectional path tracing (Veach and Guibas 1995, Lafortune and Willems 1993) in scenes with media: a walk from a
/// light and one from the sensor, each vertex of one joined with each of the other, with the sensor, and with a light;
/// lights met by chance. Multiple importance sampling over all of these, with recursive sums (StrategySums).
///
/// Paths that only the walk from the sensor can make (glowing media, a light seen in mirrors) are made by it alone;
/// what neither can make stays black: a point light seen through smooth glass by a pinhole.
class BidirectionalPathTracer : public SplattingIntegrator {
 public:
  BidirectionalPathTracer(const PathSettings& settings, const BdptSettings& own)
      : settings_(settings), own_(own), weights_(own.heuristic) {
    show_strategies(own.shown_edges);
  }

  /// (Not found, though: a delta light seen in nothing but specular vertices.)
  PathSupport support() const override {
    return {.specular_at_sensor = true, .specular_at_delta_light = true, .beams = true, .glowing_media = true};
  }

 protected:
  std::unique_ptr<Worker> make_worker(const Scene& scene, uint64_t seed, SampleCounters& counters) const override;
  void prepare_workers(const Scene& scene) override {
    sources_.emplace(scene, true);
    if (own_.refraction) scattering_ = std::make_unique<const RefractiveScattering>(scene, *own_.refraction);
  }

 private:
  PathSettings settings_;
  BdptSettings own_;
  StrategyWeights weights_;
  std::optional<LightSources> sources_;
  std::unique_ptr<const RefractiveScattering> scattering_;
};

/// The parameter `heuristic` of bidirectional methods; `value`: its default.
Parameter heuristic_parameter(const std::string& value);
StrategyWeights::Heuristic heuristic_of(const Properties& properties);
/// Their parameter `connections` (BdptSettings::connections).
Parameter connections_parameter();

/// Row of the integrator table: `bdpt`.
IntegratorPlugin bdpt_row();

}  // namespace turbid
