#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>

#include "cli/command.h"
#include "core/error.h"
#include "core/log.h"
#include "core/version.h"
#include "experiment/experiment_file.h"
#include "experiment/experiment_output.h"
#include "experiment/summary.h"
#include "render/progress.h"
#include "render/threads.h"

namespace turbid {
namespace {

/// The words after `turbid experiment`.
struct ExperimentWords {
  std::vector<std::string> names;  ///< none: list them; "all"
  bool list = false, quiet = false;
  std::string folder = "results";
  ExperimentOptions options;
  int threads = 0;
};

std::string duration_of(const Experiment& experiment, double time_scale) {
  return format_duration(experiment.declared_seconds(time_scale));
}

/// The table of experiments with the processor time that they are to take.
void print_list(const std::vector<Experiment>& experiments, double time_scale) {
  size_t width = 0;
  for (const Experiment& e : experiments) width = std::max(width, e.name.size());
  double sum = 0;
  for (const Experiment& e : experiments) {
    const double seconds = e.declared_seconds(time_scale);
    sum += seconds;
    fmt::print("{:{}}  {:>12}  {}{}{}{}\n", e.name, width, duration_of(e, time_scale), e.title,
               e.figure.empty() ? "" : " (", e.figure, e.figure.empty() ? "" : ")");
  }
  fmt::print("{:{}}  {:>12}  of processor time at --time-scale {:g}: {} with {} threads\n", "all", width,
             format_duration(sum), time_scale, format_duration(sum / thread_count()), thread_count());
}

/// Experiments by name; "all" means all that ship.
std::vector<Experiment> chosen(const std::vector<std::string>& names) {
  std::vector<Experiment> experiments;
  for (const std::string& name : names) {
    if (name == "all")
      std::ranges::move(read_experiments(experiments_folder()), std::back_inserter(experiments));
    else
      experiments.push_back(find_experiment(name));
  }
  return experiments;
}

int run_experiments(const ExperimentWords& words, const CommandLine& line) {
  const double time_scale = words.options.time_scale;
  if (words.names.empty() || words.list) {
    print_list(words.names.empty() ? read_experiments(experiments_folder()) : chosen(words.names), time_scale);
    return kExitDone;
  }
  const std::vector<Experiment> experiments = chosen(words.names);
  set_log_level(LogLevel::kWarnings);
  for (const Experiment& experiment : experiments) check_experiment(experiment, words.options.size);
  for (const Experiment& experiment : experiments) {
    ExperimentOptions options = words.options;
    options.folder = words.folder + "/" + experiment.name;
    if (options.cache.empty()) options.cache = reference_folder();
    if (!words.quiet) options.tell = [](const std::string& text) { fmt::print(stderr, "turbid: {}\n", text); };
    options.tell(fmt::format("{}: about {} of processor time", experiment.name, duration_of(experiment, time_scale)));
    const std::vector<std::string> files =
        make_experiment(experiment, options,
                        {{"command", line}, {"version", fmt::format("turbid {} {}", version(), version_commit())}});
    options.tell(fmt::format("wrote {}", fmt::join(files, ", ")));
    write_gallery(words.folder);
  }
  return kExitDone;
}

}  // namespace

Command add_experiment_command(CLI::App& app) {
  auto words = std::make_shared<ExperimentWords>();
  CLI::App* command = app.add_subcommand("experiment", "compare methods as a publication did; without a name list all");
  ExperimentOptions& options = words->options;
  command->add_option("NAME", words->names, "experiments that ship, files of others (*.json), or 'all'");
  command->add_flag("--list", words->list, "list them, with the time that they take");
  command->add_option("--time-scale", options.time_scale, "factor of all times (1)")->check(CLI::PositiveNumber);
  command->add_option("--size", options.size, "WIDTHxHEIGHT in the place of the sizes of the experiment");
  command->add_option("-o,--output", words->folder,
                      "FOLDER/NAME holds report.html, results.json ..., FOLDER/README.md pictures of all (results)");
  command->add_option("--cache", options.cache, "folder of the references (in the user's cache)");
  command->add_flag("--new-references", options.new_references, "render references again");
  command->add_option("--threads", words->threads, "number of threads (all cores)")->check(CLI::Range(1, 1024));
  command->add_flag("--quiet", words->quiet, "no progress, only warnings");
  return [words](const CommandLine& line) {
    return with_threads(words->threads, [&] { return run_experiments(*words, line); });
  };
}

}  // namespace turbid
