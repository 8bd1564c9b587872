// Single scattering through refractive boundaries: the figures of S4 as tables and plots.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>

#include "contests.h"
#include "core/log.h"
#include "flights.h"
#include "plot.h"

namespace turbid::experiments {
namespace {

/// The bumpy ball that ships; `more`: further parameters.
Flights ball(const std::string& scenes, int subdivisions, std::vector<std::string> more = {}) {
  more.insert(more.end(), {"bumps=0.12", fmt::format("subdivisions={}", subdivisions), "res=24"});
  return Flights(scenes + "/translucent_sphere.xml", more);
}

/// The statue that ships, its triangles about that long.
Flights statue(const std::string& scenes, double cell) {
  return Flights(scenes + "/glass_statue.xml", {fmt::format("cell={}", cell), "width=26", "height=40"});
}

/// Fig. 3: radiance along the flight whose light is most uneven, point by point, and what all of it brings.
void figure_3(const std::string& scenes, const std::string& plot) {
  const Flights flights = ball(scenes, 3);
  const auto roughness = [&](const Ray& flight) {
    const std::vector<double> values = flights.radiance_along(flight, 64);
    return *std::max_element(values.begin(), values.end()) / std::max(mean_of(values), 1e-30);
  };
  const Ray* chosen = &flights.all().front();
  double most = 0;
  for (size_t i = 0; i < flights.all().size(); i += 7)
    if (const double found = roughness(flights.all()[i]); found > most) {
      most = found;
      chosen = &flights.all()[i];
    }
  constexpr size_t kPoints = 4000;
  Curve radiance{"radiance", {}, flights.radiance_along(*chosen, kPoints)};
  for (size_t i = 0; i < kPoints; ++i)
    radiance.x.push_back(static_cast<double>(chosen->t_max) * (static_cast<double>(i) + 0.5) / kPoints);
  double sum = 0;
  Sampler sampler(SamplerKind::kIndependent, 7);
  SampleCounters counters;
  const RefractiveScattering scattering(flights.scene(), {.samples = 4});
  constexpr int kEstimates = 16;
  for (uint64_t i = 0; i < kEstimates; ++i) {
    sampler.start(0, i);
    sum += static_cast<double>(scattering.gather(*chosen, flights.medium(), Spectrum(1.0f), sampler, counters).mean());
  }
  fmt::print("radiance along a flight of length {:.3f}: mean {:.4g}, largest {:.4g}\n", chosen->t_max,
             mean_of(radiance.y), *std::max_element(radiance.y.begin(), radiance.y.end()));
  fmt::print("its integral by triangle intervals {:.5g}\n", sum / kEstimates);
  for (const auto& [points, starts] : {std::pair{kPoints, 1}, {64 * kPoints, 1}, {kPoints, 8}, {16 * kPoints, 8}}) {
    const double integral =
        mean_of(flights.radiance_along(*chosen, points, starts)) * static_cast<double>(chosen->t_max);
    fmt::print("by {} points, Newton's method from {} places of each triangle {:.5g}\n", points,
               starts * (starts + 1) / 2, integral);
    std::fflush(stdout);
  }
  if (plot.empty()) return;
  write_plot(plot, "In-scattered radiance along a camera ray in the bumpy ball", "distance", {radiance});
  fmt::print("written to {0}.csv and {0}.svg\n", plot);
}

/// Fig. 8 without the noise of pixels: the same camera rays by all methods, against many samples of the first.
void same_rays(const std::string& scenes) {
  const Flights flights = ball(scenes, 4);
  const std::vector<double> reference = flights.render({.samples = 64}, 99).values;
  const double peak = *std::max_element(reference.begin(), reference.end());
  fmt::print("\n{} camera rays of the bumpy ball of 5,120 triangles, the same for all\n\n", reference.size());
  fmt::print(
      "| method | us per ray | mean / reference | PSNR | MSE x s, relative |\n| --- | --- | --- | --- | --- |\n");
  double first = 0;
  const auto show = [&](const std::string& name, const RefractiveSettings& settings) {
    const Flights::Rendering r = flights.render(settings, 1);
    const double error = mean_square_difference(r.values, reference), cost = error * r.seconds;
    if (first == 0) first = cost;
    fmt::print("| {} | {:.0f} | {:.4f} | {:.1f} dB | {:.3g} |\n", name, 1e6 * r.seconds,
               mean_of(r.values) / mean_of(reference), 10 * std::log10(sqr(peak) / error), cost / first);
    std::fflush(stdout);
  };
  show("triangle intervals", {});
  show("triangle intervals, midpoint", {.in_middle = true});
  for (const int samples : {1, 4, 16, 64, 256})
    show(fmt::format("point sampling, {} points", samples),
         {.method = RefractiveMethod::kPointSampling, .samples = samples});
}

/// Fig. 10: time of a camera ray by the number of triangles.
void figure_10(const std::string& scenes) {
  const auto measure = [](const std::string& name, size_t count, const auto& flights_of) {
    fmt::print("| {} | us per camera ray | paths per ray | tree, bytes per triangle |\n| --- | --- | --- | --- |\n",
               name);
    double n = 0, sum_x = 0, sum_y = 0, sum_xx = 0, sum_xy = 0;
    for (size_t i = 0; i < count; ++i) {
      const Flights flights = flights_of(i);
      const RefractiveInterfaces interfaces(flights.scene());
      const PositionNormalTree& tree = interfaces.all().front().tree;
      const Flights::Rendering r = flights.render({}, 0);
      const auto triangles = static_cast<double>(tree.triangle_count());
      fmt::print("| {} | {:.1f} | {:.1f} | {:.1f} |\n", tree.triangle_count(), 1e6 * r.seconds,
                 static_cast<double>(r.counters.refractive_paths) / static_cast<double>(r.values.size()),
                 static_cast<double>(tree.bytes()) / triangles);
      std::fflush(stdout);
      const double x = std::log(triangles), y = std::log(r.seconds);
      n += 1;
      sum_x += x;
      sum_y += y;
      sum_xx += x * x;
      sum_xy += x * y;
    }
    fmt::print("\ntime grows as triangles^{:.2f}\n\n", (n * sum_xy - sum_x * sum_y) / (n * sum_xx - sum_x * sum_x));
  };
  measure("triangles of the bumpy ball", 4, [&](size_t i) { return ball(scenes, 5 + static_cast<int>(i)); });
  const std::array cells = {0.06, 0.03, 0.015, 0.006};
  measure("triangles of the statue", cells.size(), [&](size_t i) { return statue(scenes, cells[i]); });
}

void print_shortcut(const std::string& name, const Flights& flights, const RefractiveSettings& shortcut) {
  const std::vector<double> right = flights.render({.samples = 4}, 3).values,
                            wrong = flights.render(shortcut, 4).values;
  const std::vector<double> zero(right.size());
  fmt::print("| {} | {:.3f} | {:.1f} % |\n", name, mean_of(wrong) / mean_of(right),
             100 * std::sqrt(mean_square_difference(wrong, right) / mean_square_difference(right, zero)));
  std::fflush(stdout);
}

const std::string kShortcutHead = "| shortcut | mean / right | RMS error / RMS |\n| --- | --- | --- |\n";

/// Fig. 11: the distance squared in the place of D.
void figure_11(const std::string& scenes) {
  fmt::print("{}", kShortcutHead);
  print_shortcut("bumpy ball, without D", ball(scenes, 4), {.samples = 4, .focusing = false});
  print_shortcut("statue of 10,000 triangles, without D", statue(scenes, 0.06), {.samples = 4, .focusing = false});
}

/// Fig. 12: where the search for P comes to rest.
void figure_12(const std::string& scenes) {
  const Flights flights = ball(scenes, 4);
  fmt::print("| tolerance | intervals: us per ray | RMS error / RMS | 16 points: us per ray | RMS change / RMS |\n");
  fmt::print("| --- | --- | --- | --- | --- |\n");
  const auto settings = [](RefractiveMethod method, double tolerance) {
    return RefractiveSettings{
        .method = method, .samples = method == RefractiveMethod::kPointSampling ? 16 : 1, .tolerance = tolerance};
  };
  constexpr auto kIntervals = RefractiveMethod::kTriangleIntervals, kPoints = RefractiveMethod::kPointSampling;
  const std::vector<double> right = flights.render(settings(kIntervals, 1e-12), 5).values,
                            right_points = flights.render(settings(kPoints, 1e-12), 5).values;
  const std::vector<double> zero(right.size());
  const auto error = [&](const std::vector<double>& values, const std::vector<double>& reference) {
    return std::sqrt(mean_square_difference(values, reference) / mean_square_difference(reference, zero));
  };
  for (const double tolerance : {0.3, 0.1, 0.03, 0.01, 1e-3, 1e-4, 1e-6, 1e-8, 1e-10}) {
    // The same random numbers: what differs is the tolerance's doing.
    const Flights::Rendering r = flights.render(settings(kIntervals, tolerance), 5),
                             p = flights.render(settings(kPoints, tolerance), 5);
    fmt::print("| {:g} | {:.0f} | {:.2g} | {:.0f} | {:.2g} |\n", tolerance, 1e6 * r.seconds, error(r.values, right),
               1e6 * p.seconds, error(p.values, right_points));
    std::fflush(stdout);
  }
}

/// Fig. 13: light that is not bent, in bodies of more and more mean free paths.
void figure_13(const std::string& scenes) {
  fmt::print("{}", kShortcutHead);
  for (const double density : {0.5, 2.5, 12.5, 50.0}) {
    const Flights flights = ball(scenes, 4, {fmt::format("density={}", density)});
    const double width = 2 * static_cast<double>(flights.medium().sigma_t().mean());
    print_shortcut(fmt::format("straight line, {:.2g} mean free paths wide", width), flights,
                   {.method = RefractiveMethod::kStraightLine, .samples = 1024});
  }
}

}  // namespace

int run(int argc, char** argv) {
  CLI::App app("Refractive single scattering: the figures of S4 as tables and plots");
  app.require_subcommand(1);
  app.fallthrough();
  ContestSettings contest;
  std::string plot;
  double factor = 17;
  app.add_option("--scenes", contest.scenes, "folder of the scenes that ship");
  const auto subcommand = [&](const char* name, const char* what, const auto& draw) {
    CLI::App* command = app.add_subcommand(name, what);
    command->callback(draw);
    return command;
  };
  const auto with_pictures = [&](CLI::App* command) {
    command->add_option("--size", contest.size, "pixels along the shorter side");
    command->add_option("--samples", contest.samples, "of triangle intervals, per pixel");
    command->add_option("--reference-samples", contest.reference_samples, "of the picture that errors are told from");
    command->add_option("--images", contest.images, "folder for the pictures");
    return command;
  };
  set_log_level(LogLevel::kQuiet);
  with_pictures(subcommand("fig1", "bumpy ball, equal time", [&] { print_equal_time(contest, false); }));
  with_pictures(subcommand("fig6", "statue, equal time", [&] { print_equal_time(contest, true); }));
  subcommand("rays", "fig8 without the noise of pixels", [&] { same_rays(contest.scenes); });
  with_pictures(subcommand("fig8", "bumpy ball, the others a factor longer", [&] {
    print_equal_quality(contest, factor);
    same_rays(contest.scenes);
  }))->add_option("--factor", factor, "of time");
  subcommand("fig3", "radiance along a ray", [&] {
    figure_3(contest.scenes, plot);
  })->add_option("--plot", plot, "writes NAME.csv and NAME.svg");
  subcommand("fig10", "time against triangles", [&] { figure_10(contest.scenes); });
  subcommand("fig11", "without D", [&] { figure_11(contest.scenes); });
  subcommand("fig12", "tolerance of the search for P", [&] { figure_12(contest.scenes); });
  subcommand("fig13", "straight line against mean free path", [&] { figure_13(contest.scenes); });
  CLI11_PARSE(app, argc, argv);
  return 0;
}

}  // namespace turbid::experiments
