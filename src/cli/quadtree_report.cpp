#include "cli/quadtree_report.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <optional>

#include "image/image_file.h"
#include "render/statistics.h"
#include "table/field_plot.h"
#include "table/sphere_plot.h"

namespace turbid {
namespace {

/// One line: the energy that is in the table, over that of all light; how far that is from what the exact table has in
/// the same places; and how far lobes are from the exact ones.
void print_errors(const std::shared_ptr<const QuadtreeTable>& table, const std::optional<LobeField>& collision,
                  const std::optional<LobeField>& ray, SourceKind kind, int channel) {
  const bool segment = kind == SourceKind::kRay;
  const auto albedo = static_cast<double>(table->albedo[channel]);
  const double whole =
      (segment ? -std::expm1(-double{kUnitSegment}) : 1) * std::pow(albedo, table->settings.from_order) / (1 - albedo);
  const QuadtreeField field(table, kind, channel);
  const double energy = measure_moments(field, field.tree()).energy;
  fmt::print("{:<12} {:<10} {:>8.4f} {:>9.2f}", "", segment ? "segment" : "collision", albedo, 100 * energy / whole);
  if (!collision) {
    fmt::print("\n");
    return;
  }
  std::optional<StretchField> stretch;
  if (segment) stretch.emplace(*ray, kUnitSegment);
  const LightField& exact = segment ? static_cast<const LightField&>(*stretch) : *collision;
  const LobeDifference difference = compare_within(exact, field, collision->grid());
  fmt::print(" {:>+9.2f} {:>9.2f} {:>9.2f} {:>9.2f}\n",
             100 * (energy / measure_moments(exact, field.tree()).energy - 1), 100 * difference.lobes,
             100 * difference.shape, 100 * difference.density);
}

/// Some lobes over all directions: near the source, behind it, and that of S1 Fig. 8.
void plot_lobes(const LightField& exact, const QuadtreeField& field, SourceKind kind, const std::string& path) {
  const std::vector<Quadtree::Place> places = {{0.5f, 2}, {2, 1}, {5, 5}, {3, -2}};
  write_png(path, plot_spheres(exact, field, places));
  fmt::print("{:<12} {:<10} {:>8} {:>8} {:>9} {:>9} {:>9} {:>11}   {}\n", "in per cent", "rows of", "rho", "z", "lobes",
             "shape", "density", "compression", path);
  for (const Quadtree::Place& place : places) {
    const LobeDifference difference = compare_lobes_at(exact, field, {place.rho, 0, place.z});
    fmt::print("{:<12} {:<10} {:>8g} {:>8g} {:>9.2f} {:>9.2f} {:>9.2f} {:>11.2f}\n", "",
               kind == SourceKind::kRay ? "segment" : "collision", place.rho, place.z, 100 * difference.lobes,
               100 * difference.shape, 100 * difference.density, 100 * compression_error(exact, place, kind));
  }
}

}  // namespace

void print_quadtree(const PhaseFunction& phase, const Spectrum& albedo, const QuadtreeReport& report) {
  const std::string& folder = report.exact.folder;
  const std::string path = quadtree_path(phase, albedo, report.settings, folder);
  const bool there = std::filesystem::exists(path);
  const double before = process_cpu_seconds();
  const auto table = find_quadtree(phase, albedo, report.settings, folder);
  const double spent = process_cpu_seconds() - before;
  std::error_code ignored;
  const auto on_disk = std::filesystem::file_size(path, ignored);
  fmt::print("{:<12} {}\n", "table", path);
  fmt::print("{:<12} {} in {:.2f} s of processor time, {} photons, orders {} and more\n", "", there ? "read" : "built",
             spent, table->settings.photons, table->settings.from_order);
  fmt::print("{:<12} mean cosine {:.4f}, to {:g} mean free paths, {} and {} lobes\n", "", table->moments[1],
             table->kinds[0].tree.reach(), table->kinds[0].tree.leaf_count(), table->kinds[1].tree.leaf_count());
  fmt::print("{:<12} {:.2f} MB in memory{}\n", "", static_cast<double>(table->size()) * 1e-6,
             ignored ? "" : fmt::format(", {:.2f} MB on disk", static_cast<double>(on_disk) * 1e-6));
  std::shared_ptr<const ScatteringTable> exact;
  try {
    exact = find_table(phase, report.exact);
  } catch (const std::invalid_argument& refused) {
    fmt::print("{:<12} nothing to compare with: {}\n", "notice", refused.what());
  }
  fmt::print("{:<12} {:<10} {:>8} {:>9} {:>9} {:>9} {:>9} {:>9}\n", "in per cent", "source", "albedo", "energy",
             "error", "lobes", "shape", "density");
  for (int c = 0; c < kChannels; ++c) {
    bool said = !(albedo[c] > 0);
    for (int before_it = 0; before_it < c; ++before_it) said = said || albedo[before_it] == albedo[c];
    if (said) continue;
    std::optional<LobeField> collision, ray;
    if (exact) {
      const auto value = static_cast<double>(albedo[c]);
      collision.emplace(*exact, SourceKind::kCollision, value, report.settings.from_order);
      ray.emplace(*exact, SourceKind::kRay, value, report.settings.from_order);
    }
    for (const SourceKind kind : {SourceKind::kCollision, SourceKind::kRay})
      print_errors(table, collision, ray, kind, c);
  }
  if (report.prefix.empty()) return;
  for (const SourceKind kind : {SourceKind::kCollision, SourceKind::kRay}) {
    const std::string name = kind == SourceKind::kRay ? "segment" : "point";
    const QuadtreeField field(table, kind, 0);
    write_png(fmt::format("{}-{}-axes.png", report.prefix, name), plot_axes(field, report.reach));
    write_png(fmt::format("{}-{}-cells.png", report.prefix, name), plot_cells(field));
    if (!exact) continue;
    const LobeField computed(*exact, kind, static_cast<double>(albedo[0]), report.settings.from_order);
    const StretchField stretch(computed, kUnitSegment);
    const LightField& compared = kind == SourceKind::kRay ? static_cast<const LightField&>(stretch) : computed;
    write_png(fmt::format("{}-{}-lobes.png", report.prefix, name), plot_field(compared, report.reach, 640, &field));
    plot_lobes(compared, field, kind, fmt::format("{}-{}-sphere.png", report.prefix, name));
  }
}

}  // namespace turbid
