#include "experiment/experiment_output.h"

#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/cache_folder.h"
#include "experiment/experiment_file.h"
#include "experiment/machine.h"
#include "experiment/program_figure.h"
#include "experiment/results.h"
#include "experiment/results_page.h"
#include "experiment/run_store.h"
#include "experiment/summary.h"
#include "image/atomic_file.h"

namespace turbid {
namespace {

namespace fs = std::filesystem;

class Writer {
 public:
  explicit Writer(std::string folder) : folder_(std::move(folder)) {}

  void write(const std::string& name, const std::string& text) {
    const std::string path = folder_ + "/" + name;
    write_file_atomically(path, text);
    files_.push_back(path);
  }
  std::vector<std::string> files() const { return files_; }

 private:
  std::string folder_;
  std::vector<std::string> files_;
};

}  // namespace

std::vector<std::string> make_experiment(const Experiment& experiment, const ExperimentOptions& options,
                                         std::map<std::string, std::string> about) {
  const std::string viewer = read_viewer();  // its absence is found before the work
  check_experiment(experiment, options.size);
  make_folder(options.folder);
  about["machine"] = describe_machine();
  about["experiment"] = experiment.file;
  about["time scale"] = fmt::format("{:g}", options.time_scale);
  Writer writer(options.folder);
  if (experiment.program) {
    const RunStore store(options.folder);
    const uint64_t key = program_fingerprint(experiment, options.time_scale);
    std::string printed = store.find_text("figure", key).value_or("");
    if (printed.empty()) {
      options.tell(experiment.program->name + " ...");
      printed = run_program_figure(experiment, options.time_scale);
      store.keep_text("figure", key, printed);
    }
    about["program"] = program_line(experiment, options.time_scale);
    about["finished"] = describe_now();
    writer.write("output.md", printed);
    writer.write("summary.md", summary_of(experiment, printed));
    writer.write("report.html", to_html(report_of(experiment, printed, about), viewer));
    return writer.files();
  }
  const ExperimentResult result = run_experiment(experiment, options);
  about["finished"] = describe_now();
  writer.write("results.json", to_json(result, about).dump(1) + "\n");
  writer.write("results.csv", to_csv(result));
  writer.write("summary.md", write_summary(result, fs::path(options.folder).parent_path().string()));
  writer.write("report.html", to_html(report_of(result, about), viewer));
  return writer.files();
}

}  // namespace turbid
