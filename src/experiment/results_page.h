#pragma once
#include <map>
#include <string>

#include "experiment/experiment_run.h"
#include "report/report.h"

namespace turbid {

/// Which methods are best in a scene, in a sentence, and how far the others are behind.
ReportVerdict verdict_of(const SceneResult& scene, EqualBy rule);

/// The results as the report shows them: verdicts, images, curves of error, numbers, what was published, references.
Report report_of(const ExperimentResult& result, const std::map<std::string, std::string>& about);

/// "0.0123 ± 0.0004", the uncertainty to two digits and the value as far.
std::string with_error(const Estimate& estimate);

}  // namespace turbid
