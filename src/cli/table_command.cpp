#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>

#include "cli/command.h"
#include "cli/quadtree_report.h"
#include "core/error.h"
#include "image/image_file.h"
#include "medium/henyey_greenstein.h"
#include "medium/homogeneous.h"
#include "render/scene_choice.h"
#include "render/statistics.h"
#include "table/field_moments.h"
#include "table/field_plot.h"
#include "table/table_cache.h"

namespace turbid {
namespace {

struct TableWords {
  SceneChoice scene;
  std::optional<float> g;
  TableRequest request{{1, 0}, {}};
  std::vector<double> albedos;
  std::string out, mode = "exact";
  QuadtreeSettings photons;
  double reach = 8;
  bool ray = false, noise = false;
};

/// The phase functions that tables are asked for, and the albedos that their media have.
struct Subject {
  std::shared_ptr<const PhaseFunction> phase;
  std::vector<double> albedos;
  std::optional<Spectrum> albedo;  ///< of a medium
};

std::vector<Subject> choose_subjects(const TableWords& words) {
  if (words.g) {
    if (!words.scene.file.empty()) throw UsageError("name a scene or a mean cosine, not both");
    try {
      return {{std::make_shared<HenyeyGreensteinPhase>(*words.g), {0.5, 0.9, 0.99, 0.999}, {}}};
    } catch (const std::invalid_argument& error) {
      throw UsageError(error.what());
    }
  }
  LoadedScene loaded = open_scene(words.scene);
  const auto scene = std::make_shared<Scene>(std::move(loaded.parts));
  std::vector<Subject> subjects;
  for (const Surroundings& surroundings : scene->media()) {
    const HomogeneousMedium* medium = surroundings.medium->as_homogeneous();
    if (!medium) continue;
    Subject subject{std::shared_ptr<const PhaseFunction>(scene, &medium->phase()), {}, medium->albedo()};
    for (int c = 0; c < kChannels; ++c)
      if (const auto albedo = static_cast<double>(medium->albedo()[c]);
          albedo > 0 && std::find(subject.albedos.begin(), subject.albedos.end(), albedo) == subject.albedos.end())
        subject.albedos.push_back(albedo);
    subjects.push_back(std::move(subject));
  }
  if (subjects.empty())
    throw UsageError("the scene has no homogeneous medium: name one that has, or a mean cosine by --g");
  return subjects;
}

/// Deviations from the closed forms, in per cent: energy and mean square of the distance by themselves, the mean way
/// along the axis by the root of that.
void print_errors(const ScatteringTable& table, double albedo, SourceKind kind) {
  const FieldMoments found = measure_moments(LobeField(table, kind, albedo));
  const FieldMoments exact = exact_moments(table.moments[1], albedo, kind);
  fmt::print("{:<12} {:<10} {:>8.4f} {:>+9.2f} {:>+9.2f} {:>+9.2f}\n", "",
             kind == SourceKind::kRay ? "ray" : "collision", albedo, 100 * (found.energy / exact.energy - 1),
             100 * (found.along - exact.along) / std::sqrt(exact.square), 100 * (found.square / exact.square - 1));
}

void print_table(const PhaseFunction& phase, const std::vector<double>& albedos, const TableWords& words) {
  const std::string path = table_path(phase, words.request);
  const bool there = std::filesystem::exists(path);
  const double before = process_cpu_seconds();
  const auto table = find_table(phase, words.request);
  const double spent = process_cpu_seconds() - before;
  std::error_code ignored;
  const auto on_disk = std::filesystem::file_size(path, ignored);
  fmt::print("{:<12} {}\n", "table", path);
  fmt::print("{:<12} {} in {:.2f} s of processor time, {} samples per bin of orders\n", "", there ? "read" : "built",
             spent, table->deposits);
  fmt::print("{:<12} mean cosine {:.4f}, bands to l = {}, m = {}; {} x {} cells to {:g} mean free paths\n", "",
             table->moments[1], table->shape.bands.degree, table->shape.bands.order, table->shape.grid.radii(),
             table->shape.grid.angles(), table->shape.grid.outer());
  fmt::print("{:<12} {:.2f} MB in memory{}\n", "", static_cast<double>(table->size()) * 1e-6,
             ignored ? "" : fmt::format(", {:.2f} MB on disk", static_cast<double>(on_disk) * 1e-6));
  fmt::print("{:<12} {:<10} {:>8} {:>9} {:>9} {:>9}\n", "errors, %", "source", "albedo", "energy", "E[z]", "E[r^2]");
  for (const double albedo : albedos)
    for (const SourceKind kind : {SourceKind::kCollision, SourceKind::kRay}) print_errors(*table, albedo, kind);
  if (!words.noise) return;
  TableRequest other = words.request;
  other.settings.seed += 1;
  const auto second = find_table(phase, other);
  fmt::print("{:<12} {:<10} {:>8} {:>9} {:>9}\n", "noise, %", "source", "albedo", "lobes", "density");
  for (const double albedo : albedos)
    for (const SourceKind kind : {SourceKind::kCollision, SourceKind::kRay}) {
      const LobeField a(*table, kind, albedo), b(*second, kind, albedo);
      const LobeDifference difference = compare_lobes(a, b, a.grid());
      fmt::print("{:<12} {:<10} {:>8.4f} {:>9.2f} {:>9.2f}\n", "", kind == SourceKind::kRay ? "ray" : "collision",
                 albedo, 100 * difference.lobes / std::sqrt(2), 100 * difference.density / std::sqrt(2));
    }
}

/// Mode `seed`: a table for each material; albedos that were named are grey ones.
void print_quadtrees(const Subject& subject, const TableWords& words, bool plot) {
  QuadtreeReport report{words.photons, words.request, plot ? words.out : "", words.reach};
  report.settings.seed = words.request.settings.seed;
  if (report.prefix.ends_with(".png")) report.prefix.resize(report.prefix.size() - 4);
  if (subject.albedo && words.albedos.empty()) return print_quadtree(*subject.phase, *subject.albedo, report);
  for (const double albedo : words.albedos.empty() ? subject.albedos : words.albedos) {
    print_quadtree(*subject.phase, Spectrum(static_cast<float>(albedo)), report);
    report.prefix.clear();
  }
}

int run_table(const TableWords& words) {
  for (const double albedo : words.albedos)
    if (!(albedo >= 0 && albedo <= kLargestAlbedo))
      throw UsageError(fmt::format("--albedo must lie between 0 and {}, {} does not", kLargestAlbedo, albedo));
  const std::vector<Subject> subjects = choose_subjects(words);
  for (const Subject& subject : subjects) {
    std::vector<double> albedos = words.albedos.empty() ? subject.albedos : words.albedos;
    for (double& albedo : albedos)
      if (albedo > kLargestAlbedo) {
        fmt::print("{:<12} albedo {:g} is beyond {}, the largest that tables hold; looked at there\n", "notice", albedo,
                   kLargestAlbedo);
        albedo = kLargestAlbedo;
      }
    try {
      if (words.mode == "seed") {
        print_quadtrees(subject, words, &subject == &subjects.front());
        continue;
      }
      print_table(*subject.phase, albedos, words);
      if (words.out.empty() || &subject != &subjects.front()) continue;
      const LobeField field(*find_table(*subject.phase, words.request),
                            words.ray ? SourceKind::kRay : SourceKind::kCollision, albedos.front());
      write_png(words.out, plot_field(field, words.reach));
    } catch (const std::invalid_argument& refused) {
      throw UsageError(refused.what());
    }
  }
  return kExitDone;
}

}  // namespace

Command add_table_command(CLI::App& app) {
  auto words = std::make_shared<TableWords>();
  CLI::App* command = app.add_subcommand("table", "build, check and plot tables of multiple scattering");
  command->add_option("SCENE", words->scene.file, "tables for the homogeneous media of a scene");
  command->add_option("-D,--define", words->scene.definitions, "NAME=VALUE sets $NAME of the scene")
      ->expected(1)
      ->take_all();
  command->add_option("--g", words->g, "the table of Henyey-Greenstein with this mean cosine instead");
  command->add_option("--albedo", words->albedos, "look at these albedos; left out: those of the scene's media")
      ->take_all();
  command->add_option("--mode", words->mode, "exact, or seed: as published, a quadtree of sampled lobes per material")
      ->check(CLI::IsMember({"exact", "seed"}));
  command->add_option("--photons", words->photons.photons, "of mode seed")->check(CLI::PositiveNumber);
  command->add_option("--from-order", words->photons.from_order, "of mode seed: collisions from which on light counts")
      ->check(CLI::Range(3, 5));
  command->add_option("--samples", words->request.settings.deposits, "per bin of orders; 0: as the bands need");
  command->add_option("--seed", words->request.settings.seed, "of the simulation");
  command->add_option(
      "--folder", words->request.folder,
      "of the files; left out: $TURBID_TABLES, $XDG_CACHE_HOME/turbid/tables or ~/.cache/turbid/tables");
  command->add_flag("--noise", words->noise, "build a second table from another seed and say how far they are apart");
  command->add_option(
      "-o,--out", words->out,
      "plot density and lobes of the first medium and albedo there (PNG); mode seed: OUT-point-axes.png and more");
  command->add_flag("--ray", words->ray, "plot light that sets out along a ray, not light that collides at a point");
  command->add_option("--reach", words->reach, "of the plot to each side, in mean free paths")
      ->check(CLI::PositiveNumber);
  return [words](const CommandLine&) { return run_table(*words); };
}

}  // namespace turbid
