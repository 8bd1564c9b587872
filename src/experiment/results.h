#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "experiment/experiment_run.h"

namespace turbid {

/// A published number beside ours.
struct NumberBesideOurs {
  PublishedNumber published;
  std::string what;                ///< "rmse of uniform over that of importance caching, foggy atrium"
  std::optional<Estimate> ours{};  ///< empty where we have none
  /// Ours over the published one; for PSNR the difference in dB.
  std::optional<double> compared() const;
};
std::vector<NumberBesideOurs> beside_ours(const ExperimentResult& result);

/// The results as results.json holds them (docs/experiments.md); `about`: command, machine, version ...
nlohmann::ordered_json to_json(const ExperimentResult& result, const std::map<std::string, std::string>& about);

/// All points of all runs: scene, method, seed, seconds, wall, samples, rmse, rel_mse, mean_ratio. The reference's own
/// error is still in them.
std::string to_csv(const ExperimentResult& result);

}  // namespace turbid
