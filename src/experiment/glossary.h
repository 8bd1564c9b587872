#pragma once
#include "experiment/experiment.h"
#include "report/report.h"

namespace turbid {

/// The names of an experiment's methods and of the measures on its page, each with what it is: of methods what the rows
/// of the integrators say of their type and of what their settings choose.
std::vector<ReportTerm> glossary_of(const Experiment& experiment);

}  // namespace turbid
