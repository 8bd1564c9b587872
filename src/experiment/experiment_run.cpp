#include "experiment/experiment_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include "core/cache_folder.h"
#include "core/hash.h"
#include "experiment/contest.h"
#include "experiment/run_store.h"
#include "image/image_file.h"
#include "render/progress.h"

namespace turbid {
namespace {

namespace fs = std::filesystem;

std::string command_of(const SceneChoice& choice) {
  std::string line = "turbid render " + choice.file;
  for (const std::string& definition : choice.definitions) line += " -D " + definition;
  if (!choice.size.empty()) line += " --size " + choice.size;
  return line + " --integrator " + choice.integrator;
}

/// One scene under way.
class SceneContest {
 public:
  SceneContest(const Experiment& experiment, const ExperimentScene& scene, const ExperimentOptions& options,
               const RunStore& store)
      : experiment_(experiment),
        scene_(scene),
        options_(options),
        store_(store),
        rule_(scaled(experiment.rule, options.time_scale)) {}

  SceneResult run() {
    SceneResult result{.scene = scene_, .reference = reference(), .methods = {}};
    std::vector<StagedScene> contestants;
    for (const ExperimentMethod& method : experiment_.methods) {
      contestants.push_back(stages_.stage(choice_of(scene_, method.integrator, options_.size)));
      MethodResult& made = result.methods.emplace_back();
      made.method = method;
      made.shortcomings = contestants.back().shortcomings();
      made.command = command_of(contestants.back().choice());
    }
    for (int seed = 1; seed <= experiment_.seeds; ++seed)
      for (size_t i = 0; i < contestants.size(); ++i)
        run_once(contestants[i], static_cast<uint64_t>(seed), result.reference, result.methods[i]);
    for (MethodResult& made : result.methods) made.score = score_of(made.runs, result.reference.error, rule_.error);
    return result;
  }

 private:
  Reference reference() {
    const double seconds = scene_.reference.seconds * options_.time_scale;
    options_.tell(fmt::format("{}: reference ({}, {} of processor time)", scene_.name, scene_.reference.integrator,
                              format_duration(seconds)));
    const StagedScene staged = stages_.stage(choice_of(scene_, scene_.reference.integrator, options_.size));
    Reference reference =
        find_reference(staged, {.seconds = seconds, .folder = options_.cache, .anew = options_.new_references});
    const ReferenceError& error = reference.error;
    options_.tell(fmt::format("{}: reference {}, {} samples per pixel, RMSE {:.3g} ({:.2g} of the mean)", scene_.name,
                              reference.is_new ? "rendered" : "from the cache", reference.samples,
                              std::sqrt(error.mse.value), std::sqrt(error.mse.value) / error.mean));
    Image image = reference.image;
    image.metadata = {{"integrator", scene_.reference.integrator}, {"samples", std::to_string(reference.samples)}};
    write_exr(store_.image_path(file_name(scene_.name) + "-reference"), image);
    return reference;
  }

  uint64_t fingerprint(const StagedScene& contestant, uint64_t seed, const Reference& reference) const {
    const std::string rest =
        fmt::format("{} {} {} {} {} {} {}", static_cast<int>(rule_.equal), rule_.seconds, rule_.samples, rule_.error,
                    experiment_.points, reference.key, reference.samples);
    return hash_bytes(rest, contestant.fingerprint(seed));
  }

  void run_once(const StagedScene& contestant, uint64_t seed, const Reference& reference, MethodResult& made) const {
    const std::string picture = file_name(scene_.name) + "-" + file_name(made.method.name);
    const std::string name = fmt::format("{}-{}", picture, seed), image_path = store_.image_path(picture);
    const uint64_t key = fingerprint(contestant, seed, reference);
    if (auto stored = store_.find(name, key); stored && (seed > 1 || fs::exists(image_path))) {
      if (seed == 1) made.image = read_exr(image_path);
      made.runs.push_back(std::move(*stored));
      return;
    }
    MethodRun run = run_method(contestant, rule_, experiment_.points, seed, reference);
    const CurvePoint& end = run.curve.back();
    options_.tell(fmt::format("{}: {}, seed {}: {} samples per pixel in {} of processor time, RMSE {:.4g}", scene_.name,
                              made.method.name, seed, end.samples, format_duration(end.seconds),
                              std::sqrt(std::max(0.0, end.error.mse - reference.error.mse.value))));
    if (seed == 1) {
      run.image.metadata = {{"scene", scene_.file},
                            {"integrator", made.method.integrator},
                            {"command", made.command},
                            {"seed", "1"},
                            {"samples", std::to_string(end.samples)},
                            {"seconds", fmt::format("{:.3f}", end.wall)}};
      write_exr(image_path, run.image);
      made.image = std::move(run.image);
    }
    store_.keep(name, key, run.curve);
    made.runs.push_back(std::move(run.curve));
  }

  const Experiment& experiment_;
  const ExperimentScene& scene_;
  const ExperimentOptions& options_;
  const RunStore& store_;
  const ComparisonRule rule_;
  Stages stages_;
};

}  // namespace

std::string reference_folder() { return cache_folder("references", "TURBID_REFERENCES"); }

const MethodResult& SceneResult::method(const std::string& name) const {
  return *std::ranges::find_if(methods, [&](const MethodResult& made) { return made.method.name == name; });
}

std::optional<Estimate> merit(const MethodScore& score, EqualBy rule) {
  switch (rule) {
    case EqualBy::kTime:
      return score.cost;
    case EqualBy::kSamples:
      return score.rmse;
    default:
      return score.seconds_to_error;
  }
}

bool is_surely_worse(const SceneResult& scene, const MethodResult& method, const MethodResult& best, EqualBy rule) {
  const auto own = merit(method.score, rule), least = merit(best.score, rule);
  if (!own || !least) return least.has_value();
  if (own->value - least->value > 2 * std::hypot(own->error, least->error)) return true;
  if (rule == EqualBy::kError || method.runs.size() < 3) return false;
  const auto of_run = [&](const Curve& run) {
    const double square = run.back().error.mse - scene.reference.error.mse.value;
    return rule == EqualBy::kTime ? square * run.back().seconds : square;
  };
  return of_run(*std::ranges::min_element(method.runs, {}, of_run)) >
         of_run(*std::ranges::max_element(best.runs, {}, of_run));
}

std::vector<const MethodResult*> ranked(const SceneResult& scene, EqualBy rule) {
  std::vector<const MethodResult*> methods;
  for (const MethodResult& made : scene.methods) methods.push_back(&made);
  const auto key = [&](const MethodResult* made) {
    const auto value = merit(made->score, rule);
    return value ? value->value : std::numeric_limits<double>::infinity();
  };
  std::ranges::stable_sort(methods, {}, key);
  return methods;
}

ComparisonRule scaled(const ComparisonRule& rule, double time_scale) {
  ComparisonRule result = rule;
  result.seconds *= time_scale;
  result.error /= std::sqrt(time_scale);
  if (rule.samples > 0)
    result.samples =
        std::max<uint64_t>(1, static_cast<uint64_t>(std::llround(static_cast<double>(rule.samples) * time_scale)));
  return result;
}

ExperimentResult run_experiment(const Experiment& experiment, const ExperimentOptions& options) {
  const RunStore store(options.folder);
  ExperimentResult result{experiment, scaled(experiment.rule, options.time_scale), options.time_scale, {}};
  for (const ExperimentScene& scene : experiment.scenes)
    result.scenes.push_back(SceneContest(experiment, scene, options, store).run());
  return result;
}

}  // namespace turbid
