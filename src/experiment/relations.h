#pragma once
#include <nlohmann/json_fwd.hpp>

#include "experiment/experiment_run.h"
#include "report/report.h"

namespace turbid {

/// How far the picture of a method's first seed is from that of another.
struct PairDifference {
  std::string scene;
  MethodPair pair;
  double rmse = 0, psnr = 0, mean_ratio = 0;  ///< of psnr the peak is that of the scene's reference
  bool equal_samples = true;                  ///< else one of them ran out of time, and noise is in the numbers
};
std::vector<PairDifference> differences_of(const ExperimentResult& result);

/// What a method costs beside the baseline in one scene: the baseline's merit over its own. Time for the same error; at
/// equal samples, the error.
struct AgainstBaseline {
  std::string scene, method;
  std::optional<Estimate> factor{};   ///< above 1: better than the baseline
  bool is_lost_in_reference = false;  ///< more than half of its squared error is the reference's
  double mean_ratio = 1;
};
/// Empty without a baseline.
std::vector<AgainstBaseline> against_baseline(const ExperimentResult& result);

/// As tables of the report: methods down, scenes across; and a row for each pair and scene.
ReportTable baseline_table(const ExperimentResult& result);
ReportTable pairs_table(const ExperimentResult& result);

/// As parts of results.json.
nlohmann::ordered_json baseline_json(const ExperimentResult& result);
nlohmann::ordered_json pairs_json(const ExperimentResult& result);

}  // namespace turbid
