#pragma once
#include <functional>
#include <string>
#include <vector>

#include "experiment/experiment.h"
#include "experiment/reference.h"
#include "experiment/score.h"

namespace turbid {

struct ExperimentOptions {
  double time_scale = 1;  ///< of all times (and samples; errors to reach grow by its root)
  std::string size;       ///< "WxH" in the place of the scenes' sizes
  std::string folder;     ///< what is made: runs/ while it goes on, images/ and the results in the end
  std::string cache;      ///< folder of references
  bool new_references = false;
  std::function<void(const std::string&)> tell = [](const std::string&) {};  ///< progress, a line each
};

/// The folder of references: $TURBID_REFERENCES, else in the user's cache.
std::string reference_folder();

struct MethodResult {
  ExperimentMethod method;
  std::vector<Curve> runs;  ///< of seeds 1, 2 ...
  MethodScore score;
  Image image;  ///< of seed 1
  std::vector<std::string> shortcomings;
  std::string command;  ///< that renders such an image
};

struct SceneResult {
  ExperimentScene scene;
  Reference reference;
  std::vector<MethodResult> methods;

  const MethodResult& method(const std::string& name) const;
};

/// What methods are ranked by, the less the better: squared error x time at equal time, RMSE at equal samples, time at
/// equal error (empty where that was not reached).
std::optional<Estimate> merit(const MethodScore& score, EqualBy rule);

/// True when `method` is worse than `best` beyond doubt: by more than two standard errors, or in every one of at least
/// three runs worse than in any of the best's (rare bright samples make standard errors as large as what they are of).
bool is_surely_worse(const SceneResult& scene, const MethodResult& method, const MethodResult& best, EqualBy rule);

/// The methods of a scene, the best first; those without merit last.
std::vector<const MethodResult*> ranked(const SceneResult& scene, EqualBy rule);

struct ExperimentResult {
  Experiment experiment;
  ComparisonRule rule;  ///< as scaled
  double time_scale = 1;
  std::vector<SceneResult> scenes;
};

/// The rule at another scale of time: samples follow it, and an error to reach its inverse root.
ComparisonRule scaled(const ComparisonRule& rule, double time_scale);

/// Runs all methods on all scenes with all seeds. Methods take turns, a seed each. Whatever is finished is kept in the
/// folder and found again when the same experiment runs once more, unless what it depends on has changed (scene,
/// settings, program, reference). Throws Interrupted, and what scenes and files throw.
ExperimentResult run_experiment(const Experiment& experiment, const ExperimentOptions& options);

}  // namespace turbid
