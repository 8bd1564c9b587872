#include "experiment/summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "core/cache_folder.h"
#include "experiment/relations.h"
#include "experiment/results_page.h"
#include "experiment/run_store.h"
#include "image/atomic_file.h"
#include "image/image_file.h"

namespace turbid {
namespace {

namespace fs = std::filesystem;

std::string heading(const Experiment& experiment) {
  return fmt::format("## {}\n{}{}{}\n\n`turbid experiment {}`\n", experiment.title, experiment.figure,
                     experiment.figure.empty() ? "" : ". ", experiment.about, experiment.name);
}

/// A picture as a cell of a table.
std::string cell(const Experiment& experiment, const ExperimentScene& scene, const std::string& name,
                 const Image& image, const std::string& folder) {
  const std::string path = fmt::format("{}/images/{}-{}.png", experiment.name, file_name(scene.name), file_name(name));
  make_folder(fs::path(folder + "/" + path).parent_path().string());
  write_png(folder + "/" + path, image, scene.exposure);
  return fmt::format("![{}, {}]({}) |", scene.name, name, path);
}

std::string pictures_of(const ExperimentResult& result, const SceneResult& scene, const std::string& folder) {
  std::string names = "| |", rule = "| --- |", pictures = "| |", errors = "| RMSE |", means = "| mean / reference |",
              times = "| s |";
  const auto add = [&](const std::string& name, const Image& image, const std::string& error, const std::string& mean,
                       const std::string& time) {
    names += fmt::format(" {} |", name);
    rule += " --- |";
    pictures += " " + cell(result.experiment, scene.scene, name, image, folder);
    errors += fmt::format(" {} |", error);
    means += fmt::format(" {} |", mean);
    times += fmt::format(" {} |", time);
  };
  const Reference& reference = scene.reference;
  add("reference", reference.image, with_error({std::sqrt(reference.error.mse.value), 0}), "",
      fmt::format("{:.3g}", reference.wall));
  for (const MethodResult* made : ranked(scene, result.rule.equal)) {
    const MethodScore& score = made->score;
    add(made->method.name, made->image, with_error(score.rmse), with_error(score.mean_ratio),
        fmt::format("{:.3g}", score.seconds.value));
  }
  return fmt::format("{}\n{}\n{}\n{}\n{}\n{}\n", names, rule, pictures, errors, means, times);
}

std::string markdown_of(const ReportTable& table) {
  std::string text = "\n" + table.title + "\n\n|", rule = "|";
  for (const std::string& column : table.columns) {
    text += fmt::format(" {} |", column);
    rule += " --- |";
  }
  text += "\n" + rule + "\n";
  for (const auto& row : table.rows) {
    text += "|";
    for (const ReportTable::Cell& value : row)
      text += std::holds_alternative<double>(value) ? fmt::format(" {:.4g} |", std::get<double>(value))
                                                    : fmt::format(" {} |", std::get<std::string>(value));
    text += "\n";
  }
  return text;
}

}  // namespace

std::string write_summary(const ExperimentResult& result, const std::string& folder) {
  std::string text = heading(result.experiment);
  for (const SceneResult& scene : result.scenes) {
    const ReportVerdict verdict = verdict_of(scene, result.rule.equal);
    text += fmt::format("\n**{}**: {}{}{}\n\n{}", scene.scene.name, verdict.winner, verdict.winner.empty() ? "" : ": ",
                        verdict.text, pictures_of(result, scene, folder));
  }
  if (!result.experiment.baseline.empty()) text += markdown_of(baseline_table(result));
  if (!result.experiment.pairs.empty()) text += markdown_of(pairs_table(result));
  return text;
}

std::string summary_of(const Experiment& experiment, const std::string& printed) {
  return heading(experiment) + "\n" + printed;
}

std::string write_gallery(const std::string& folder) {
  std::vector<fs::path> summaries;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder))
    if (const fs::path path = entry.path() / "summary.md"; fs::exists(path)) summaries.push_back(path);
  std::ranges::sort(summaries);
  std::string text =
      "# Experiments\nWritten by `turbid experiment`. Errors are RMSE with standard errors over seeds, that of the "
      "reference subtracted; times are processor time (references: wall time); the best method is next to the "
      "reference.\n";
  for (const fs::path& path : summaries) text += "\n" + read_file(path.string());
  const std::string path = folder + "/README.md";
  write_file_atomically(path, text);
  return path;
}

}  // namespace turbid
