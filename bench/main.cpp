#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "core/version.h"
#include "renders.h"

/// Times kernels and whole renders; prints tables and writes one JSON report.
namespace turbid::bench {
namespace {

/// Google Benchmark's table, keeping items per second by name.
class Table final : public benchmark::ConsoleReporter {
 public:
  Table() : ConsoleReporter(OO_Tabular) {}
  void ReportRuns(const std::vector<Run>& runs) override {
    for (const Run& run : runs) {
      const auto items = run.counters.find("items_per_second");
      if (!run.error_occurred && items != run.counters.end())
        rates_.push_back({run.benchmark_name(), items->second.value});
    }
    ConsoleReporter::ReportRuns(runs);
  }

  const std::vector<std::pair<std::string, double>>& rates() const { return rates_; }
  double rate(const std::string& name) const {
    for (const auto& [kernel, rate] : rates_)
      if (kernel == name) return rate;
    return std::nan("");
  }

 private:
  std::vector<std::pair<std::string, double>> rates_;
};

nlohmann::ordered_json time_kernels(const std::string& filter) {
  Table table;
  benchmark::RunSpecifiedBenchmarks(&table, filter);
  nlohmann::ordered_json json;
  for (const auto& [kernel, rate] : table.rates()) json["items_per_second"][kernel] = rate;
  const std::pair<const char*, const char*> pairs[] = {{"ray_nearest", "embree_nearest/robust"},
                                                       {"ray_occluded", "embree_occluded"}};
  for (const auto& [ours, embree] : pairs) {
    const double ratio = table.rate(ours) / table.rate(embree);
    if (std::isnan(ratio)) continue;
    fmt::print("{} / {}: {:.1f} %\n", ours, embree, 100 * ratio);
    json["relative_to_embree"][ours] = ratio;
  }
  return json;
}

nlohmann::ordered_json time_renders(const std::string& program, const std::string& scenes,
                                    const std::vector<std::string>& names, int samples_per_pixel) {
  fmt::print("\n{:<20}{:>16}{:>12}{:>12}{:>20}{:>12}\n", "scene", "Msamples/s", "seconds", "RMSE", "RMSE^2 x seconds",
             "MiB");
  auto json = nlohmann::ordered_json::array();
  for (const std::string& name : names) {
    const RenderResult r = measure_render(program, scenes + "/" + name + ".xml", samples_per_pixel);
    fmt::print("{:<20}{:>16.3f}{:>12.2f}{:>12.5f}{:>20.4g}{:>12.0f}\n", r.scene, r.samples_per_second * 1e-6, r.seconds,
               r.rmse, r.efficiency, static_cast<double>(r.peak_memory) / 1048576.0);
    std::fflush(stdout);
    json.push_back({{"scene", r.scene},
                    {"samples", r.samples},
                    {"seconds", r.seconds},
                    {"samples_per_second", r.samples_per_second},
                    {"rmse", r.rmse},
                    {"rmse2_seconds", r.efficiency},
                    {"peak_memory_bytes", r.peak_memory}});
  }
  return json;
}

int run(int argc, char** argv) {
  std::string program, scenes, out, filter = ".";
  std::vector<std::string> names;
  int samples_per_pixel = 64;
  bool kernels_only = false, renders_only = false;
  CLI::App app("Times kernels (of one thread) and whole renders (of all threads)");
  app.add_option("--program", program, "the turbid that renders");
  app.add_option("--scenes", scenes, "the folder of the scenes");
  app.add_option("-o,--out", out, "the JSON report");
  app.add_option("--spp", samples_per_pixel, "samples per pixel of each of a scene's two renders")
      ->check(CLI::PositiveNumber);
  app.add_option("--filter", filter, "time only the kernels whose name matches this expression");
  app.add_option("--scene", names, "render only these scenes");
  auto* kernels = app.add_flag("--kernels", kernels_only, "kernels only");
  app.add_flag("--renders", renders_only, "renders only")->excludes(kernels);
  CLI11_PARSE(app, argc, argv);
  if (names.empty()) names = {"clear_sphere", "wax_sphere", "candle"};

  nlohmann::ordered_json report = {
      {"version", version()}, {"commit", version_commit()}, {"threads", std::thread::hardware_concurrency()}};
  if (!renders_only) report["kernels"] = time_kernels(filter);
  if (!kernels_only) report["renders"] = time_renders(program, scenes, names, samples_per_pixel);
  if (!out.empty()) {
    const std::filesystem::path path(out);
    if (path.has_parent_path()) std::filesystem::create_directories(path.parent_path());
    std::ofstream file(path);
    file << report.dump(2) << "\n";
    if (!file.flush()) throw std::runtime_error("cannot write " + out);
    fmt::print("\nwrote {}\n", out);
  }
  return 0;
}

}  // namespace
}  // namespace turbid::bench

int main(int argc, char** argv) {
  try {
    return turbid::bench::run(argc, argv);
  } catch (const std::exception& error) {
    fmt::print(stderr, "turbid bench: {}\n", error.what());
    return 1;
  }
}
