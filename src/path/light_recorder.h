#pragma once
#include <optional>

#include "path/subpath.h"

namespace turbid {

/// The StrategySums at the first vertex behind a light: next-event estimation from there, and finding the light by
/// chance, against the start of the walk. `straight`: what the edge lets through.
StrategySums sums_behind_light(const Scene& scene, const StrategyWeights& weights, const Emission& emission,
                               const EdgeEnd& end, const Spectrum& straight);

/// Keeps the StrategySums of walks from lights. Their vertices know them by arrive().
class LightRecorder : public SubpathRecorder<TransportMode::kImportance> {
 public:
  LightRecorder(const Scene& scene, const StrategyWeights& weights) : SubpathRecorder(weights), scene_(scene) {}

  void at_emitter(const Emission& emission, const Traveller&) {
    emission_ = emission;
    start_edge();
  }

 protected:
  StrategySums arrive(const EdgeEnd& end, const PathState& state) const {
    return state.depth == 1 ? sums_behind_light(scene_, weights_, *emission_, end, straight_) : sums_at(end);
  }

  const Scene& scene_;
  std::optional<Emission> emission_;
};

}  // namespace turbid
