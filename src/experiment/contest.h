#pragma once
#include "experiment/experiment.h"
#include "experiment/reference.h"
#include "experiment/score.h"
#include "experiment/staged_scene.h"

namespace turbid {

/// One render of one method under a rule.
struct MethodRun {
  Curve curve;
  Image image;  ///< the last one
};

/// Renders in this process, and notes the error at up to `points` moments: the last at the end, each other one at half
/// the time (or samples) of the next. Time for looking at errors does not count. A run ends with the first pass that
/// goes beyond its time. Throws Interrupted.
MethodRun run_method(const StagedScene& staged, const ComparisonRule& rule, int points, uint64_t seed,
                     const Reference& reference);

}  // namespace turbid
