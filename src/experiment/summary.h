#pragma once
#include <string>
#include <vector>

#include "experiment/experiment_run.h"

namespace turbid {

/// The results in Markdown, for a gallery of experiments: verdicts, and for each scene a row of pictures, the best
/// method first, with errors and times. Writes the pictures as PNG, `folder`/NAME/images/*.png; links lead there from
/// `folder`.
std::string write_summary(const ExperimentResult& result, const std::string& folder);
/// The same for what the program of an experiment printed.
std::string summary_of(const Experiment& experiment, const std::string& printed);

/// Writes `folder`/README.md from the summaries of all experiments that have one there, in the order of their names.
/// Returns its path.
std::string write_gallery(const std::string& folder);

}  // namespace turbid
