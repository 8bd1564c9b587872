#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>

#include "cli/command.h"
#include "core/error.h"
#include "core/log.h"
#include "core/version.h"
#include "image/atomic_file.h"
#include "integrator/advice.h"
#include "render/progress.h"
#include "render/render_job.h"
#include "render/scene_choice.h"
#include "render/threads.h"

namespace turbid {
namespace {

/// The words after `turbid render`.
struct RenderWords {
  SceneChoice scene;
  std::string output;
  std::optional<uint64_t> spp, passes;
  std::optional<double> seconds;
  int threads = 0;
  uint64_t seed = 0;
  bool resume = false, variance = false, quiet = false;
  float exposure = 0;
  double save_seconds = 60;
  std::string json;
};

/// OUT.exr as given, or named after the scene, in the current folder.
std::string output_path(const RenderWords& words) {
  if (words.output.empty())
    return words.scene.file.empty() ? "turbid.exr" : std::filesystem::path(words.scene.file).stem().string() + ".exr";
  if (std::filesystem::path(words.output).extension() != ".exr")
    throw UsageError("-o expects a name that ends in .exr, found '" + words.output + "'");
  return words.output;
}

/// The name under which Mitsuba's moment integrator files its layers: that of the integrator inside.
std::string moment_name(const SceneNode& wrapper) {
  for (const Child& child : wrapper.children)
    if (child.node->category == Category::kIntegrator)
      return !child.name.empty() ? child.name : !child.node->id.empty() ? child.node->id : "integrator";
  return "integrator";
}

RenderOptions render_options(const RenderWords& words, const LoadedScene& loaded, const Scene& scene,
                             bool second_moment, const CommandLine& line) {
  RenderOptions options;
  options.budget = {words.spp, words.passes, words.seconds};
  if (!words.spp && !words.passes && !words.seconds) options.budget.samples = scene.sample_count();
  options.seed = words.seed;
  options.resume = words.resume;
  options.quiet = words.quiet;
  options.save_seconds = words.save_seconds;
  options.fingerprint = scene_fingerprint(words.scene, loaded.files, words.seed);
  OutputSettings& output = options.output;
  output.path = output_path(words);
  output.exposure = words.exposure;
  output.variance = words.variance;
  output.alpha = scene.film().alpha;
  output.outliers = scene.film().outliers;
  if (second_moment) output.moment_name = moment_name(*loaded.integrator.node);
  if (scene.film().crop_size.x > 0) {
    output.crop_offset = scene.film().crop_offset;
    output.film_size = scene.film().size;
  }
  output.metadata = {{"scene", words.scene.name()},
                     {"command", line},
                     {"version", fmt::format("turbid {} {}", version(), version_commit())},
                     {"integrator", describe_integrator(*loaded.integrator.node)},
                     {"seed", std::to_string(words.seed)}};
  return options;
}

std::string joined(const std::vector<std::string>& words) { return fmt::format("{}", fmt::join(words, ", ")); }

/// What a person wants to know at the end.
void report(const RenderResult& result, const OutputSettings& output) {
  const RenderStatistics& s = result.statistics;
  if (const uint64_t dropped = s.counter("dropped_samples"))
    log_warning(fmt::format("dropped {} of {} samples, which were negative or not finite", dropped, s.samples));
  if (result.files.empty()) {
    log_notice("interrupted before the first pass was whole: nothing is written");
    return;
  }
  log_notice(fmt::format("{}wrote {}: {} samples per pixel, {}, {:.2f} million samples/s",
                         s.interrupted ? "interrupted; " : "", joined(result.files), s.samples_per_pixel,
                         format_duration(result.seconds), s.samples_per_second() * 1e-6));
  if (s.interrupted)
    log_notice(fmt::format("{} was left; the same command with --resume goes on", output.checkpoint_path()));
}

int run_render(const RenderWords& words, const CommandLine& line) {
  if (words.quiet) set_log_level(LogLevel::kWarnings);
  output_path(words);  // wrong words are found before the scene is read
  if (!words.json.empty() && words.json != "-") check_writable(words.json);
  LoadedScene loaded = open_scene(words.scene);
  const IntegratorSetup setup = make_integrator(loaded.integrator, loaded.document.get());
  const Scene scene(std::move(loaded.parts));
  for (const std::string& missed : missed_light(loaded.integrator, *setup.integrator, scene)) log_warning(missed);
  if (const std::string ignored = ignored_media(loaded.integrator, *setup.integrator, scene); !ignored.empty())
    log_warning(ignored);
  const RenderOptions options = render_options(words, loaded, scene, setup.second_moment, line);
  const RenderResult result = render(make_task(scene, *setup.integrator), options);
  report(result, options.output);
  if (!words.json.empty()) {
    const std::string json = to_json(result.statistics, options.output.metadata);
    if (words.json == "-")
      fmt::print("{}", json);
    else
      write_file_atomically(words.json, json);
  }
  return result.statistics.interrupted ? kExitInterrupted : kExitDone;
}

}  // namespace

Command add_render_command(CLI::App& app) {
  auto words = std::make_shared<RenderWords>();
  CLI::App* command = app.add_subcommand("render", "render a scene to an EXR file and a PNG beside it");
  command->add_option("SCENE", words->scene.file, "a Mitsuba 3 scene file; left out: the scene inside the program");
  command->add_option("-o,--output", words->output, "image file, ends in .exr (SCENE.exr in the current folder)");
  command->add_option("-D,--define", words->scene.definitions, "NAME=VALUE sets $NAME of the scene")
      ->expected(1)
      ->take_all();
  command->add_option("--integrator", words->scene.integrator,
                      "TYPE[,KEY=VALUE]... in the place of the scene's integrator");
  CLI::Option* spp =
      command->add_option("--spp", words->spp, "samples per pixel, exactly")->check(CLI::Range(1u, 1u << 31));
  CLI::Option* passes = command->add_option("--passes", words->passes, "whole passes")->check(CLI::Range(1u, 1u << 31));
  CLI::Option* time =
      command->add_option("--time", words->seconds, "seconds, at least one pass")->check(CLI::PositiveNumber);
  spp->excludes(passes)->excludes(time);
  passes->excludes(time);
  command->add_option("--size", words->scene.size, "WIDTHxHEIGHT of the image in pixels");
  command->add_option("--threads", words->threads, "number of threads (all cores)")->check(CLI::Range(1, 1024));
  command->add_option("--seed", words->seed, "another seed, another noise (0)");
  command->add_flag("--resume", words->resume, "go on from OUT.ckpt if it exists, and leave one at the end");
  command->add_flag("--variance", words->variance, "write the variance of one sample to OUT_var.exr");
  command->add_option("--exposure", words->exposure, "stops by which the PNG is brightened (0)")
      ->check(CLI::Range(-100.0, 100.0));
  command->add_option("--save-every", words->save_seconds, "seconds between saves of image and checkpoint (60)")
      ->check(CLI::NonNegativeNumber);
  command->add_option("--json", words->json, "write statistics to this file, - for standard output");
  command->add_flag("--quiet", words->quiet, "no progress, only warnings");
  return [words](const CommandLine& line) {
    return with_threads(words->threads, [&] { return run_render(*words, line); });
  };
}

}  // namespace turbid
