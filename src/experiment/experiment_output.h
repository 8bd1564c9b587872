#pragma once
#include <map>
#include <string>
#include <vector>

#include "experiment/experiment_run.h"

namespace turbid {

/// Runs an experiment, or its program, and writes results.json, results.csv and report.html (or, for a program, its
/// text as output.md), and summary.md for a gallery, into `options.folder` (FOLDER/NAME) in one step each. `about`:
/// command, version ...; the machine and the time are added. Returns the names of the files.
std::vector<std::string> make_experiment(const Experiment& experiment, const ExperimentOptions& options,
                                         std::map<std::string, std::string> about);

}  // namespace turbid
