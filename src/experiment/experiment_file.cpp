#include "experiment/experiment_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>

#include "core/cache_folder.h"
#include "core/error.h"
#include "experiment/json_object.h"
#include "experiment/score.h"
#include "scene/suggestions.h"

namespace turbid {
namespace {

namespace fs = std::filesystem;

ComparisonRule read_rule(const JsonObject& json) {
  static const std::vector<std::string> kKinds = {"equal time", "equal samples", "equal error"};
  ComparisonRule rule;
  const std::string kind = json.text("by");
  const auto found = std::ranges::find(kKinds, kind);
  if (found == kKinds.end()) json.fail("unknown rule '" + kind + "'" + suggestion(kind, kKinds), "by");
  rule.equal = static_cast<EqualBy>(found - kKinds.begin());
  rule.seconds = json.positive("seconds");
  if (rule.equal == EqualBy::kSamples) rule.samples = static_cast<uint64_t>(json.count("samples"));
  if (rule.equal == EqualBy::kError) rule.error = json.positive("error");
  json.finish();
  return rule;
}

ReferenceSettings read_reference(const JsonObject& json) {
  ReferenceSettings reference{json.text("integrator"), json.positive("seconds")};
  json.finish();
  return reference;
}

/// What scenes have unless they say otherwise.
struct Common {
  fs::path folder;
  std::string size;
  std::optional<ReferenceSettings> reference{};
};

ExperimentScene read_scene(const JsonObject& json, const Common& common) {
  ExperimentScene scene;
  scene.name = json.text("name");
  scene.file = (common.folder / json.text("file")).lexically_normal().string();
  scene.definitions = json.assignments("define");
  scene.size = json.text("size", common.size);
  scene.exposure = static_cast<float>(json.number("exposure", 0));
  const bool own = json.has("reference") || !common.reference;
  scene.reference = own ? read_reference(json.object("reference")) : *common.reference;
  json.finish();
  if (!fs::exists(scene.file)) json.fail("there is no scene " + scene.file, "file");
  return scene;
}

ProgramSettings read_program(const JsonObject& json) {
  ProgramSettings program{.name = json.text("name"),
                          .arguments = json.texts("arguments"),
                          .seconds = json.positive("seconds"),
                          .shorter = json.texts("shorter")};
  if (!program.shorter.empty()) program.shorter_seconds = json.positive("shorter_seconds");
  json.finish();
  return program;
}

template <class Named>
std::vector<std::string> names_of(const std::vector<Named>& all) {
  std::vector<std::string> names;
  for (const Named& one : all) names.push_back(one.name);
  return names;
}

/// Names become parts of files' names, so these must differ.
template <class Named>
void require_distinct(const JsonObject& json, const std::string& key, const std::vector<Named>& all) {
  if (all.empty()) json.fail("needs at least one", key);
  std::vector<std::string> names = names_of(all);
  for (std::string& name : names) name = file_name(name);
  std::ranges::sort(names);
  const auto twice = std::ranges::adjacent_find(names);
  if (twice != names.end()) json.fail("two have the same name (as a file: '" + *twice + "')", key);
}

void require_known(const JsonObject& json, const std::string& key, const std::string& name,
                   const std::vector<std::string>& known) {
  if (std::ranges::find(known, name) == known.end())
    json.fail("unknown " + key + " '" + name + "'" + suggestion(name, known), key);
}

MethodPair read_pair(const JsonObject& json, const std::vector<std::string>& methods) {
  MethodPair pair{json.text("method"), json.text("against")};
  require_known(json, "method", pair.method, methods);
  require_known(json, "against", pair.against, methods);
  json.finish();
  return pair;
}

PublishedNumber read_published(const JsonObject& json, const Experiment& experiment) {
  PublishedNumber number{.scene = json.text("scene"),
                         .method = json.text("method"),
                         .over = json.text("over", ""),
                         .measure = json.text("measure"),
                         .value = json.number("value"),
                         .from = json.text("from", experiment.figure)};
  require_known(json, "scene", number.scene, names_of(experiment.scenes));
  require_known(json, "method", number.method, names_of(experiment.methods));
  if (!number.over.empty()) require_known(json, "over", number.over, names_of(experiment.methods));
  require_known(json, "measure", number.measure, MethodScore::measures());
  json.finish();
  return number;
}

void read_contest(const JsonObject& json, const fs::path& folder, Experiment& experiment) {
  experiment.rule = read_rule(json.object("compare"));
  experiment.seeds = json.count("seeds", 4);
  if (experiment.seeds < 2) json.fail("expected at least 2: uncertainties come from repeated seeds", "seeds");
  experiment.points = std::min(json.count("points", 6), 20);
  Common common{folder, json.text("size", "")};
  if (json.has("reference")) common.reference = read_reference(json.object("reference"));
  for (const JsonObject& scene : json.objects("scenes")) experiment.scenes.push_back(read_scene(scene, common));
  for (const JsonObject& method : json.objects("methods")) {
    experiment.methods.push_back({method.text("name"), method.text("integrator")});
    method.finish();
  }
  require_distinct(json, "scenes", experiment.scenes);
  require_distinct(json, "methods", experiment.methods);
  const std::vector<std::string> methods = names_of(experiment.methods);
  experiment.baseline = json.text("baseline", "");
  if (!experiment.baseline.empty()) require_known(json, "baseline", experiment.baseline, methods);
  for (const JsonObject& pair : json.objects("pairs")) experiment.pairs.push_back(read_pair(pair, methods));
  if (!experiment.pairs.empty() && experiment.rule.equal != EqualBy::kSamples)
    json.fail("pictures have noise in common only when compared by equal samples", "pairs");
  for (const JsonObject& number : json.objects("published"))
    experiment.published.push_back(read_published(number, experiment));
}

/// What went wrong, with the place in the experiment's file before it.
template <class Check>
void check_part(const Experiment& experiment, const std::string& part, const Check& check) {
  try {
    check();
  } catch (const Error& error) {
    throw Error(experiment.file + ": " + part + ": " + error.what(), error.exit_code());
  }
}

}  // namespace

std::string experiments_folder() {
  if (const std::string named = environment_variable("TURBID_EXPERIMENTS"); !named.empty()) return named;
  return fs::exists(TURBID_EXPERIMENTS_HERE) ? TURBID_EXPERIMENTS_HERE : TURBID_EXPERIMENTS_INSTALLED;
}

Experiment read_experiment(const std::string& path) {
  const nlohmann::json text = read_json(path);
  const JsonObject json(text, path, "");
  Experiment experiment;
  experiment.file = path;
  experiment.name = fs::path(path).stem().string();
  experiment.title = json.text("title");
  experiment.figure = json.text("figure", "");
  experiment.about = json.text("about", "");
  if (json.has("program"))
    experiment.program = read_program(json.object("program"));
  else
    read_contest(json, fs::path(path).parent_path(), experiment);
  json.finish();
  return experiment;
}

std::vector<Experiment> read_experiments(const std::string& folder) {
  std::vector<std::string> paths;
  if (fs::is_directory(folder))
    for (const auto& entry : fs::directory_iterator(folder))
      if (entry.path().extension() == ".json") paths.push_back(entry.path().string());
  std::ranges::sort(paths);
  std::vector<Experiment> experiments;
  for (const std::string& path : paths) experiments.push_back(read_experiment(path));
  return experiments;
}

Experiment find_experiment(const std::string& name) {
  if (name.ends_with(".json")) return read_experiment(name);
  const fs::path folder = experiments_folder();
  const std::string path = (folder / (name + ".json")).string();
  if (fs::exists(path)) return read_experiment(path);
  std::vector<std::string> names;
  if (fs::is_directory(folder))
    for (const auto& entry : fs::directory_iterator(folder))
      if (entry.path().extension() == ".json") names.push_back(entry.path().stem().string());
  std::ranges::sort(names);
  throw UsageError("unknown experiment '" + name + "'" + suggestion(name, names) + "\n'turbid experiment' lists them");
}

void check_experiment(const Experiment& experiment, const std::string& size) {
  for (const ExperimentScene& scene : experiment.scenes) {
    check_part(experiment, "reference of scene '" + scene.name + "'",
               [&] { read_chosen(choice_of(scene, scene.reference.integrator, size)); });
    for (const ExperimentMethod& method : experiment.methods)
      check_part(experiment, "method '" + method.name + "' in scene '" + scene.name + "'",
                 [&] { read_chosen(choice_of(scene, method.integrator, size)); });
  }
}

}  // namespace turbid
