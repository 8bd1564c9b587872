#pragma once
#include <string>
#include <vector>

#include "experiment/experiment.h"

namespace turbid {

/// The folder of the experiments that ship: $TURBID_EXPERIMENTS, else that of the sources, else of the installation.
std::string experiments_folder();

/// Reads an experiment from its file, whose every name and value is checked (docs/experiments.md lists them); scene
/// files are found from the file's folder. Throws FileError.
Experiment read_experiment(const std::string& path);

/// All experiments of a folder by name. Throws FileError for a broken one.
std::vector<Experiment> read_experiments(const std::string& folder);

/// The one that `name` means: a path (it ends in .json), or the name of one that ships. Throws UsageError with the
/// nearest name, FileError.
Experiment find_experiment(const std::string& name);

/// Makes sure that everything that the experiment names can be read and made, before hours of work: scenes, their
/// parameters, integrators and theirs. Throws Error, whose message begins with the experiment's file and the place in
/// it.
void check_experiment(const Experiment& experiment, const std::string& size);

}  // namespace turbid
