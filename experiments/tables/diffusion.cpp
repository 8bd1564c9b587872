// S1 Fig. 19 and 21: light around a photon's first collision in a medium without end, by the diffusion approximation,
// by the table with double scattering added, and by random walks (the truth). Lengths in mean free paths.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <array>
#include <cmath>
#include <numbers>

#include "core/frame.h"
#include "core/gauss_legendre.h"
#include "core/log.h"
#include "core/parallel.h"
#include "core/rng.h"
#include "medium/henyey_greenstein.h"
#include "methods.h"
#include "table/lobe_field.h"
#include "table/table_cache.h"

namespace turbid::experiments {
namespace {

constexpr std::array kRadii{0.5, 1.0, 2.0, 4.0, 8.0, 16.0};
constexpr double kHalfWidth = 0.05;  ///< of a shell, over its radius

/// A cone of directions about the photon's, by cosines.
struct Sector {
  const char* name;
  double from, to;
};
constexpr std::array<Sector, 3> kSectors{{{"all around", -1, 1}, {"ahead", 0.8, 1}, {"behind", -1, -0.8}}};

struct Cell {
  double sum = 0, squares = 0;
};
using Cells = std::array<std::array<Cell, kSectors.size()>, kRadii.size()>;

double volume(size_t shell, const Sector& sector) {
  const double inner = kRadii[shell] * (1 - kHalfWidth), outer = kRadii[shell] * (1 + kHalfWidth);
  return 2 * std::numbers::pi * (sector.to - sector.from) * (outer * outer * outer - inner * inner * inner) / 3;
}

/// Walks of photons that collide at the origin: what leaves collisions of the second and higher orders, per volume.
Cells walk(const PhaseFunction& phase, double albedo, size_t photons, uint64_t seed) {
  constexpr size_t kTasks = 64;
  std::vector<Cells> parts(kTasks);
  parallel_for(kTasks, [&](size_t task) {
    Cells& cells = parts[task];
    Rng rng(hash_counters(seed, task));
    for (size_t i = task; i < photons; i += kTasks) {
      std::array<std::array<double, kSectors.size()>, kRadii.size()> own{};
      Imath::V3d x(0);
      Vec3 direction(0, 0, 1);
      while (rng.next_double() < albedo) {
        const float mu = phase.sample(rng.next_float());
        direction = normalize(direction_about(direction, mu, 2 * kPi * rng.next_float()));
        x += Imath::V3d(direction) * -std::log1p(-rng.next_double());
        const double r = x.length(), cosine = x.z / r;
        for (size_t s = 0; s < kRadii.size(); ++s) {
          if (std::abs(r / kRadii[s] - 1) > kHalfWidth) continue;
          for (size_t k = 0; k < kSectors.size(); ++k)
            if (cosine >= kSectors[k].from && cosine <= kSectors[k].to) own[s][k] += albedo / volume(s, kSectors[k]);
        }
      }
      for (size_t s = 0; s < kRadii.size(); ++s)
        for (size_t k = 0; k < kSectors.size(); ++k) {
          cells[s][k].sum += own[s][k];
          cells[s][k].squares += own[s][k] * own[s][k];
        }
    }
  });
  Cells all{};
  for (const Cells& part : parts)
    for (size_t s = 0; s < kRadii.size(); ++s)
      for (size_t k = 0; k < kSectors.size(); ++k) {
        all[s][k].sum += part[s][k].sum;
        all[s][k].squares += part[s][k].squares;
      }
  return all;
}

/// The mean over a shell's sector of a density that depends on radius and cosine.
template <class Density>
double mean_over(size_t shell, const Sector& sector, const Density& density) {
  const GaussLegendre radial(8), angular(32);
  const double inner = kRadii[shell] * (1 - kHalfWidth), outer = kRadii[shell] * (1 + kHalfWidth);
  double sum = 0;
  for (size_t a = 0; a < radial.size(); ++a)
    for (size_t b = 0; b < angular.size(); ++b) {
      const double r = std::lerp(inner, outer, radial.node(a));
      sum += radial.weight(a) * (outer - inner) * angular.weight(b) * (sector.to - sector.from) * 2 * std::numbers::pi *
             r * r * density(r, std::lerp(sector.from, sector.to, angular.node(b)));
    }
  return sum / volume(shell, sector);
}

void print(double g, double albedo, size_t photons) {
  const HenyeyGreensteinPhase phase(static_cast<float>(g));
  const LobeField field(*find_table(phase, {}), SourceKind::kCollision, albedo);
  const Cells truth = walk(phase, albedo, photons, 1);
  const double reduced = 1 - g * albedo, diffusion = 1 / (3 * reduced), kappa = std::sqrt(3 * (1 - albedo) * reduced);
  // S1 eq. 17-20: an isotropic source at the collision. The last collision's albedo is in what leaves it.
  const auto by_diffusion = [&](double r, double) {
    return albedo * albedo * std::exp(-kappa * r) / (4 * std::numbers::pi * diffusion * r);
  };
  const auto by_table = [&](double r, double cosine) {
    const Vec3 x(Imath::V3d(r * std::sqrt(std::max(0.0, 1 - cosine * cosine)), 0, r * cosine));
    const double twice =
        albedo * albedo * static_cast<double>(phase.eval(static_cast<float>(cosine))) * std::exp(-r) / (r * r);
    return static_cast<double>(field.density(x, {0, 0, 1})) + twice;
  };
  fmt::print("\ng = {:g}, albedo {:g}: light that leaves collisions of order 2 and more, over that of {} walks\n\n", g,
             albedo, photons);
  fmt::print("| mean free paths | where | walks | ± % | table and double scattering | diffusion |\n");
  fmt::print("| --- | --- | --- | --- | --- | --- |\n");
  for (size_t s = 0; s < kRadii.size(); ++s)
    for (size_t k = 0; k < kSectors.size(); ++k) {
      const double n = static_cast<double>(photons), mean = truth[s][k].sum / n;
      const double error = std::sqrt(std::max(0.0, truth[s][k].squares / n - mean * mean) / n);
      fmt::print("| {:g} | {} | {:.3g} | {:.1f} | {:.3f} | {:.3f} |\n", kRadii[s], kSectors[k].name, mean,
                 100 * error / mean, mean_over(s, kSectors[k], by_table) / mean,
                 mean_over(s, kSectors[k], by_diffusion) / mean);
    }
}

}  // namespace

int run(int argc, char** argv) {
  CLI::App app("Diffusion and tables against random walks in a medium without end (S1 Fig. 19, 21)");
  size_t photons = 400'000;
  app.add_option("--photons", photons, "that walk")->check(CLI::PositiveNumber);
  CLI11_PARSE(app, argc, argv);
  set_log_level(LogLevel::kQuiet);
  print(0, 2 / 2.01, photons);     // S1 Fig. 19, 20
  print(0.9, 0.955, photons * 4);  // S1 Fig. 21, the bumpy sphere's red
  print(0.9, 0.677, photons * 16);
  return 0;
}

}  // namespace turbid::experiments
