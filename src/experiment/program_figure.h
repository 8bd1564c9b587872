#pragma once
#include <map>
#include <string>

#include "experiment/experiment.h"
#include "report/report.h"

namespace turbid {

/// Runs the program of an experiment (from $TURBID_PROGRAMS, else experiments/ beside the running program) from the
/// folder above the experiments', and returns what it printed. Its messages go to standard error. Throws UsageError
/// when it is not built, Error when it fails, Interrupted.
std::string run_program_figure(const Experiment& experiment, double time_scale);

/// Names what the figure depends on: the program's contents and its arguments. Throws as run_program_figure.
uint64_t program_fingerprint(const Experiment& experiment, double time_scale);

/// The program and its arguments, as run.
std::string program_line(const Experiment& experiment, double time_scale);

/// What it printed as a report of tables.
Report report_of(const Experiment& experiment, const std::string& printed,
                 const std::map<std::string, std::string>& about);

}  // namespace turbid
