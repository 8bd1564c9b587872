// Once-more scattered connections beside what they are compared with: the figures of Hanika et al. 2022 as tables.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>

#include "core/log.h"
#include "methods.h"

namespace turbid::experiments {
namespace {

struct Method {
  std::string name, integrator;
};

const std::string kSplat = "ptracer,camera_connection=", kGather = "volpath,nee=";
const std::string kOrderOne = ",min_scattering=1,max_scattering=1";
constexpr uint32_t kSamples = 4, kReferenceSamples = 1024;

Stage unit_test(const std::string& scenes, double g, const std::string& phase = "hg") {
  return Stage(scenes + "/point_in_fog.xml", {fmt::format("g={}", g), "phase=" + phase});
}

/// Of other seeds than those that are measured.
Image reference_of(const Stage& stage) {
  return stage.render(kSplat + "mis" + kOrderOne, kReferenceSamples, 1000).image;
}

/// The part of Henyey and Greenstein's phase function that turns back.
double backward_part(double g) {
  if (g < 1e-6) return 0.5;
  return (1 - g * g) / (2 * g) * (1 / std::sqrt(1 + g * g) - 1 / (1 + g));
}

/// Relative RMSE of the seed's combination: its own estimator for the forward hemisphere and equiangular sampling along
/// the pixels' rays for the backward one, each with all samples.
double seed_with_equiangular(const std::string& scenes, double g, double mean) {
  const double back = backward_part(g);
  const auto rmse = [&](const std::string& phase, const std::string& method) {
    const Stage stage = unit_test(scenes, g, phase);
    return measure_noise(stage, method + kOrderOne, kSamples, reference_of(stage)).rmse;
  };
  return std::hypot((1 - back) * rmse("forward_hg", kSplat + "once_more,sampling=seed"),
                    back * rmse("backward_hg", kGather + "equiangular")) /
         mean;
}

/// Fig. 11: RMSE over the mean at 4 samples per pixel, by g.
void figure_11(const std::string& scenes) {
  const std::vector<Method> methods = {
      {"distance sampling", kGather + "standard"}, {"equiangular", kGather + "equiangular"},
      {"product, tabulated", kGather + "product"}, {"geometry, splatted", kSplat + "once_more,sampling=geometry"},
      {"angle, splatted", kSplat + "once_more"},   {"mis, splatted", kSplat + "mis"},
      {"mis, gathered", kGather + "mis"}};
  fmt::print("| g | seed + equiangular |");
  for (const Method& method : methods) fmt::print(" {} |", method.name);
  fmt::print("\n| --- | --- |");
  for (size_t i = 0; i < methods.size(); ++i) fmt::print(" --- |");
  fmt::print("\n");
  for (const double g : {0.0, 0.2, 0.4, 0.6, 0.8, 0.9, 0.95, 0.99}) {
    const Stage stage = unit_test(scenes, g);
    const Image reference = reference_of(stage);
    fmt::print("| {} | {:.3f} |", g, seed_with_equiangular(scenes, g, mean_of(reference)));
    for (const Method& method : methods)
      fmt::print(" {:.3f} |", measure_noise(stage, method.integrator + kOrderOne, kSamples, reference).relative);
    fmt::print("\n");
    std::fflush(stdout);
  }
}

void print_costs(const Stage& stage, const std::vector<Method>& methods, uint32_t samples, const Image& reference) {
  fmt::print("| method | RMSE / mean | CPU s | RMSE^2 x s, of the first |\n| --- | --- | --- | --- |\n");
  double first = 0;
  for (const Method& method : methods) {
    const Noise noise = measure_noise(stage, method.integrator, samples, reference, 3);
    if (first == 0) first = noise.cost();
    fmt::print("| {} | {:.3f} | {:.2f} | 1 / {:.3g} |\n", method.name, noise.relative, noise.seconds,
               first / noise.cost());
    std::fflush(stdout);
  }
}

/// Fig. 10: all of a phase function drawn, what turns back rejected, against a forward one; and Fig. 12, the forward
/// hemisphere alone.
void figures_10_and_12(const std::string& scenes) {
  const auto splatted = [](const std::string& name, const std::string& technique) {
    return Method{name, kSplat + technique + kOrderOne};
  };
  const auto gathered = [](const std::string& name, const std::string& technique) {
    return Method{name, kGather + technique + kOrderOne};
  };
  for (const auto& [phase, g] : {std::pair{"hg", 0.5}, {"forward_hg", 0.5}, {"forward_hg", 0.9}}) {
    fmt::print("\n{} {}:\n\n", phase, g);
    const Stage stage = unit_test(scenes, g, phase);
    print_costs(stage,
                {gathered("distance sampling", "standard"), gathered("equiangular", "equiangular"),
                 gathered("product, tabulated", "product"), splatted("seed", "once_more,sampling=seed"),
                 splatted("angle", "once_more"), splatted("mis", "mis")},
                kSamples * 16, reference_of(stage));
  }
}

/// Fig. 13 to 16: a whole scene.
void whole_scene(const std::string& file, uint32_t samples, const std::string& size, bool by_light) {
  const size_t cross = size.find('x');
  const Stage stage(file, {"width=" + size.substr(0, cross), "height=" + size.substr(cross + 1)});
  const std::string& which = by_light ? kSplat : kGather;
  std::vector<Method> methods;
  for (const char* technique : {"standard", "equiangular", "product", "once_more", "mis"})
    methods.push_back({technique, which + technique});
  print_costs(stage, methods, samples, stage.render(which + "mis", 64 * samples, 1000).image);
}

}  // namespace

int run(int argc, char** argv) {
  CLI::App app("Once-more scattered connections: the figures of Hanika et al. 2022 as tables");
  app.require_subcommand(1);
  std::string scenes = "experiments/once_more", file, size = "120x100";
  uint32_t samples = 64;
  bool by_light = false;
  app.add_option("--scenes", scenes, "the folder of the unit test");
  auto* eleven = app.add_subcommand("fig11", "unit test: noise against g");
  auto* ten = app.add_subcommand("fig10", "unit test: forward hemispheres (Fig. 10 and 12)");
  auto* scene = app.add_subcommand("scene", "a whole scene (Fig. 13 to 16)");
  scene->add_option("file", file)->required();
  scene->add_option("--size", size);
  scene->add_option("--spp", samples);
  scene->add_flag("--by-light", by_light, "light tracing instead of path tracing");
  CLI11_PARSE(app, argc, argv);
  set_log_level(LogLevel::kQuiet);
  if (*eleven) figure_11(scenes);
  if (*ten) figures_10_and_12(scenes);
  if (*scene) whole_scene(file, samples, size, by_light);
  return 0;
}

}  // namespace turbid::experiments
