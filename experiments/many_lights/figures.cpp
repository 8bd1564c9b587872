// Figures 1, 5 and 6 of seed 2 as tables: the error of choosing among virtual lights against the sum over all of them,
// at equal processor time. Every method sees the same lights from the same places, so that the choice alone makes the
// difference. The numbers of the seed stand beside: its scenes, machine and units differ, so that only ratios and
// shares are to be compared.
#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "core/log.h"
#include "image/metrics.h"
#include "methods.h"

namespace turbid::experiments {
namespace {

struct Setting {
  std::string scene;
  int lights, caches, samples;  ///< as in the seed: caches on surfaces and in media together, samples of our method
};

struct Options {
  std::string scenes = "scenes";
  std::vector<int> figures = {1, 5, 6};
  std::string only;
  int size = 512, volume_points = 15;
  double scale = 1;  ///< of lights and caches
  std::string samples;
  std::vector<std::string> definitions;
  uint64_t seed = 1;
};

struct Result {
  Stage::Shot shot;
  double rmse = 0;
  double cache_share = 0;  ///< of the processor time
};

class Comparison {
 public:
  Comparison(const Options& options, const Setting& setting)
      : options_(options), setting_(setting), stage_(options.scenes + "/" + setting.scene, definitions(options)) {
    const auto scaled = [&](int n) { return static_cast<int>(n * options.scale); };
    common_ = fmt::format(
        "vpl,lights={},reuse=1000000,direct_samples=1,volume_points={},surface_caches={},volume_caches={}",
        scaled(setting.lights), options.volume_points, scaled(setting.caches) / 2, scaled(setting.caches) / 2);
    reference_ = stage_.render(common_ + ",light_sampler=all", 1, options.seed);
    mean_ = mean_of(reference_.image);
  }

  const Stage::Shot& reference() const { return reference_; }
  double mean() const { return mean_; }

  Result measure(const std::string& sampler, int samples) const {
    Result result;
    result.shot =
        stage_.render(fmt::format("{},light_sampler={},light_samples={}", common_, sampler, samples), 1, options_.seed);
    result.rmse =
        compare_images(color_channels(result.shot.image, sampler), color_channels(reference_.image, "reference")).rmse;
    result.cache_share = static_cast<double>(result.shot.counters["cache_milliseconds"]) / (1000 * result.shot.seconds);
    return result;
  }

  /// As many samples as take about so long.
  std::pair<int, Result> measure_in(const std::string& sampler, double seconds, int first) const {
    Result result = measure(sampler, first);
    const int samples = std::max(1, static_cast<int>(std::lround(first * seconds / result.shot.seconds)));
    if (std::abs(samples - first) > first / 20) result = measure(sampler, samples);
    return {samples, result};
  }

 private:
  static std::vector<std::string> definitions(const Options& options) {
    auto all = options.definitions;
    all.push_back(fmt::format("width={}", options.size));
    all.push_back(fmt::format("height={}", options.size));
    return all;
  }

  const Options& options_;
  const Setting& setting_;
  Stage stage_;
  std::string common_;
  Stage::Shot reference_;
  double mean_ = 0;
};

void print_head(const std::string& title) {
  fmt::print(
      "\n{}\n| method | light samples | CPU s | caches, share of time | RMSE | RMSE / mean | over caching | seed |\n"
      "| --- | --- | --- | --- | --- | --- | --- | --- |\n",
      title);
}

void print_row(const std::string& name, int samples, const Result& result, double mean, double caching,
               const std::string& seed) {
  fmt::print("| {} | {} | {:.1f} | {} | {:.4g} | {:.4f} | {:.2f} | {} |\n", name, samples, result.shot.seconds,
             result.cache_share > 0 ? fmt::format("{:.0f} %", 100 * result.cache_share) : "", result.rmse,
             result.rmse / mean, result.rmse / caching, seed);
}

void print_reference(const Comparison& comparison, const Result& caching, const std::string& seed) {
  fmt::print("All lights: {:.1f} CPU s, {} virtual lights, {:.1f} times as long as importance caching (seed: {}).\n",
             comparison.reference().seconds, comparison.reference().counters.at("virtual_lights"),
             comparison.reference().seconds / caching.shot.seconds, seed);
}

int samples_of(const Options& options, const Setting& setting) {
  return options.samples.empty() ? setting.samples : std::stoi(options.samples);
}

/// Figures 1 and 5: importance caching, uniform and by power, in the time of the first.
void compare_at_equal_time(const Options& options, const Setting& setting, const std::string& title,
                           const std::string& faster, const std::string& ours, const std::string& uniform,
                           const std::string& power) {
  const Comparison comparison(options, setting);
  const int samples = samples_of(options, setting);
  const Result caching = comparison.measure("importance_cache", samples);
  print_head(title);
  print_row("importance caching", samples, caching, comparison.mean(), caching.rmse, ours);
  struct Other {
    std::string name, sampler, seed;
  };
  const std::vector<Other> others = {{"caching, mixed as in the seed", "importance_cache,cache_mixture=seed", ""},
                                     {"uniform", "uniform", uniform},
                                     {"power", "power", power},
                                     {"light tree", "light_tree", ""}};
  for (const Other& other : others) {
    const auto [count, result] = comparison.measure_in(other.sampler, caching.shot.seconds, samples);
    print_row(other.name, count, result, comparison.mean(), caching.rmse, other.seed);
  }
  print_reference(comparison, caching, faster);
}

/// Figure 6: against the choice by L f G at each place, which asks all lights there.
void compare_with_unshadowed(const Options& options, const Setting& setting) {
  const Comparison comparison(options, setting);
  const int samples = samples_of(options, setting);
  const Result caching = comparison.measure("importance_cache", samples);
  print_head("Figure 6 (" + setting.scene + "): against L f G");
  print_row("importance caching", samples, caching, comparison.mean(), caching.rmse, "674 s");
  print_row("lfg", std::max(1, samples / 8), comparison.measure("lfg", std::max(1, samples / 8)), comparison.mean(),
            caching.rmse, "1807 s, more noise");
  print_reference(comparison, caching, "not given");
}

}  // namespace

int run(int argc, char** argv) {
  CLI::App app("The figures of importance caching as tables");
  Options options;
  app.add_option("--scenes", options.scenes, "folder of the scenes");
  app.add_option("--figure", options.figures, "1, 5, 6");
  app.add_option("--only", options.only, "part of the name of the one scene to render");
  app.add_option("--size", options.size, "pixels across");
  app.add_option("--scale", options.scale, "factor of the numbers of lights and caches of the seed");
  app.add_option("--volume-points", options.volume_points, "on each way through the fog");
  app.add_option("--samples", options.samples, "light samples of importance caching; else as the seed");
  app.add_option("--seed", options.seed, "of all methods");
  app.add_option("-D", options.definitions, "name=value of the scenes");
  CLI11_PARSE(app, argc, argv);
  set_log_level(LogLevel::kQuiet);
  const auto run_if_asked = [&](const Setting& setting, const auto& compare) {
    if (setting.scene.find(options.only) != std::string::npos) compare(setting);
  };
  const Setting atrium{"foggy_atrium.xml", 15'000, 30'000, 150}, room{"conference_room.xml", 10'000, 15'000, 100};
  for (const int figure : options.figures) {
    if (figure == 1)
      run_if_asked(atrium, [&](const Setting& setting) {
        compare_at_equal_time(options, setting, "Figure 1 (foggy_atrium.xml): equal time", "53", "0.0354, caches 38 %",
                              "0.1483 (4.2)", "");
      });
    if (figure == 5) {
      run_if_asked(atrium, [&](const Setting& setting) {
        compare_at_equal_time(options, setting, "Figure 5 (foggy_atrium.xml): equal time", "58", "0.0146",
                              "0.111 (7.6)", "not given");
      });
      run_if_asked(room, [&](const Setting& setting) {
        compare_at_equal_time(options, setting, "Figure 5 (conference_room.xml): equal time", "55", "0.0238",
                              "0.111 (4.7)", "not given");
      });
    }
    if (figure == 6)
      run_if_asked({"foggy_atrium.xml", 100'000, 30'000, 128},
                   [&](const Setting& setting) { compare_with_unshadowed(options, setting); });
  }
  return 0;
}

}  // namespace turbid::experiments
