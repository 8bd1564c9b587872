// S1 Table 1: what tables of its materials cost, as published, in mode `seed` and in mode `exact`; and how far lobes
// are off: those computed and those compressed (S1 Fig. 26), against the exact table.
#include "medium/materials.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <map>

#include "medium/henyey_greenstein.h"
#include "methods.h"
#include "render/statistics.h"
#include "table/table_cache.h"

namespace turbid::experiments {
namespace {

struct Published {
  std::string material;
  double memory, segment_seconds, point_seconds;  ///< MB, and on 40 cores
};

struct Options {
  QuadtreeSettings photons;
  size_t samples = 0;
  std::string only;
  bool lobes = true;
};

/// Tables of mode `exact` by mean cosine: one serves all albedos.
struct ExactTable {
  ScatteringTable table;
  double seconds;
};

const ExactTable& exact_table(float g, size_t samples) {
  static std::map<float, ExactTable> tables;
  if (const auto found = tables.find(g); found != tables.end()) return found->second;
  const HenyeyGreensteinPhase phase(g);
  TableShape shape;
  shape.bands = choose_bands(phase);
  const double before = process_cpu_seconds();
  ScatteringTable table = build_table(phase, shape, {1, samples > 0 ? samples : default_deposits(shape.bands)});
  return tables.emplace(g, ExactTable{std::move(table), process_cpu_seconds() - before}).first->second;
}

std::string errors(const LightField& exact, const QuadtreeField& field, const PolarGrid& grid) {
  const LobeDifference difference = compare_within(exact, field, grid);
  return fmt::format("{:.1f} ({:.1f})", 100 * difference.lobes, 100 * difference.shape);
}

void measure(const Published& published, const Options& options) {
  const Material* material = find_material(published.material);
  if (!material) throw std::runtime_error("there is no material " + published.material);
  const HenyeyGreensteinPhase phase(material->g[0]);
  const Spectrum albedo = material->sigma_s / (material->sigma_s + material->sigma_a);
  const double before = process_cpu_seconds();
  auto computed = simulate_photons(phase, albedo, options.photons);
  const auto sampled = std::make_shared<const QuadtreeTable>(compress_lobes(computed, phase, albedo, options.photons));
  const double seconds = process_cpu_seconds() - before;
  const double full = static_cast<double>(computed[0].values.size() + computed[1].values.size()) * 4e-6;
  const ExactTable& exact = exact_table(material->g[0], options.samples);
  fmt::print("| {} | {:.1f} | {:.3f} | {:.2f} | {:.0f} + {:.0f} | {:.0f} | {:.2f} | {:.1f} | {:.2f} | {:.1f} |",
             published.material, phase.mean_cosine(), albedo[0], published.memory, published.segment_seconds,
             published.point_seconds, full, static_cast<double>(sampled->size()) * 1e-6, seconds,
             static_cast<double>(exact.table.size()) * 1e-6, exact.seconds);
  if (options.lobes) {
    const double red = std::min(static_cast<double>(albedo[0]), kLargestAlbedo);
    const LobeField collision(exact.table, SourceKind::kCollision, red, options.photons.from_order),
        ray(exact.table, SourceKind::kRay, red, options.photons.from_order);
    const StretchField segment(ray, kUnitSegment);
    const auto kept = [&](size_t kind) { return std::make_shared<const PhotonLobes>(std::move(computed[kind])); };
    fmt::print(" {} | {} | {} | {} |", errors(collision, QuadtreeField(kept(0), 0), collision.grid()),
               errors(collision, QuadtreeField(sampled, SourceKind::kCollision, 0), collision.grid()),
               errors(segment, QuadtreeField(kept(1), 0), collision.grid()),
               errors(segment, QuadtreeField(sampled, SourceKind::kRay, 0), collision.grid()));
  }
  fmt::print("\n");
  std::fflush(stdout);
}

}  // namespace

int run(int argc, char** argv) {
  Options options;
  CLI::App app("Tables of S1's materials: memory, time and lobes (S1 Table 1, Fig. 26)");
  app.add_option("--photons", options.photons.photons, "of mode seed");
  app.add_option("--samples", options.samples, "of mode exact, per bin of orders; 0: as the bands need");
  app.add_option("--only", options.only, "materials whose name ends so");
  app.add_flag("!--no-lobes", options.lobes, "leave out the errors of lobes");
  CLI11_PARSE(app, argc, argv);
  fmt::print(
      "Memory in MB; seconds of processor time here, of 40 cores in S1 (segments + points). Lobes of the red channel "
      "against the exact table, where the quadtree is: difference in per cent (of lobes made equal in density), "
      "computed and as sampled.\n\n"
      "| material | g | albedo (red) | S1 MB | S1 s | computed MB | seed MB | seed s | exact MB | exact s |{}\n"
      "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |{}\n",
      options.lobes ? " point, computed | point, sampled | segment, computed | segment, sampled |" : "",
      options.lobes ? " --- | --- | --- | --- |" : "");
  for (const Published& published : {Published{"S1 Bumpy Sphere", 1.88, 18, 2},
                                     {"S1 Wax", 1.24, 28, 2},
                                     {"S1 Milk", 1.32, 28, 2},
                                     {"S1 Skin", 0.45, 15, 2},
                                     {"S1 Marble", 0.46, 27, 3}})
    if (published.material.ends_with(options.only)) measure(published, options);
  return 0;
}

}  // namespace turbid::experiments
