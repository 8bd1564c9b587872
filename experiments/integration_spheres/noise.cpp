// Noise and time of gathering volumes on one scene: spheres for q from 1 to 0.01, and cylinders. Prints, for each, the
// variance of an image (mean over pixels and channels), its processor time, its counted work, and their products over
// the least; and what the compound Poisson analysis (docs/integration-spheres.md) says from q = 1 and q = 0.1 alone.
#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "core/log.h"
#include "integrator/gather_pilot.h"
#include "integrator/integrators.h"
#include "render/statistics.h"
#include "scene/loader.h"

namespace turbid {
namespace {

struct Row {
  std::string name;
  double q;  ///< 0: not spheres
  double variance, seconds, work;
};

Row measure(const LoadedScene& loaded, const Scene& scene, const std::string& name,
            std::vector<std::pair<std::string, std::string>> settings, uint32_t images) {
  settings.emplace_back("keep", "1");  // images alike
  const auto replaced = replace_integrator(loaded.integrator, "mcrt", settings);
  const IntegratorSetup setup = make_integrator(replaced.description);
  StopFlag stop;
  constexpr uint64_t kSeed = 3;
  setup.integrator->prepare(scene, kSeed, stop);
  Film film(scene.film().image_size());
  const double seconds = process_cpu_seconds(), work = work_of(setup.integrator->counters());
  setup.integrator->render_pass(scene, {kSeed, 0, images}, film, stop);
  return {name, 0, mean_variance(film), (process_cpu_seconds() - seconds) / images,
          (work_of(setup.integrator->counters()) - work) / images};
}

int run(int argc, char** argv) {
  CLI::App app("Noise and time of gathering volumes");
  std::string file;
  uint32_t images = 8;
  std::vector<std::string> definitions, extra;
  app.add_option("scene", file)->required();
  app.add_option("--images", images, "of each kind");
  app.add_option("-D", definitions, "name=value of the scene");
  app.add_option("--set", extra, "key=value of the integrator");
  CLI11_PARSE(app, argc, argv);
  set_log_level(LogLevel::kQuiet);
  const auto pairs = [](const std::vector<std::string>& texts) {
    std::vector<std::pair<std::string, std::string>> result;
    for (const std::string& text : texts) {
      const size_t equals = text.find('=');
      result.emplace_back(text.substr(0, equals), text.substr(equals + 1));
    }
    return result;
  };
  Overrides overrides;
  for (const auto& [name, value] : pairs(definitions)) overrides[name] = value;
  LoadedScene loaded = load_scene(file, overrides);
  const Scene scene(std::move(loaded.parts));

  std::vector<Row> rows;
  for (const double q : {1.0, 0.5, 0.3, 0.2, 0.1, 0.05, 0.03, 0.02, 0.01}) {
    auto settings = pairs(extra);
    settings.emplace_back("q", fmt::format("{}", q));
    rows.push_back(measure(loaded, scene, fmt::format("q = {}", q), settings, images));
    rows.back().q = q;
  }
  for (const char* kind : {"short", "long"}) {
    auto settings = pairs(extra);
    settings.emplace_back("volumes", "cylinder");
    settings.emplace_back("cylinders", kind);
    rows.push_back(measure(loaded, scene, fmt::format("{} cylinders", kind), settings, images));
  }

  const auto at = [&](double q) {
    return *std::find_if(rows.begin(), rows.end(), [&](const Row& r) { return r.q == q; });
  };
  const QTradeOff trade = trade_off({1, at(1).variance, at(1).work}, {0.1, at(0.1).variance, at(0.1).work});
  const auto least = [&](double (*value)(const Row&)) {
    double result = value(rows.front());
    for (const Row& row : rows) result = std::min(result, value(row));
    return result;
  };
  const auto by_time = [](const Row& r) { return r.variance * r.seconds; };
  const auto by_work = [](const Row& r) { return r.variance * r.work; };
  const double least_time = least(by_time), least_work = least(by_work);
  fmt::print(
      "| volumes | variance | predicted | CPU s per image | work, casts | variance x time | variance x work |\n");
  fmt::print("| --- | --- | --- | --- | --- | --- | --- |\n");
  for (const Row& row : rows)
    fmt::print("| {} | {:.4g} | {} | {:.3f} | {:.3g} | {:.2f} | {:.2f} |\n", row.name, row.variance,
               row.q > 0 ? fmt::format("{:.4g}", trade.variance + trade.variance_by_q * row.q) : "", row.seconds,
               row.work, by_time(row) / least_time, by_work(row) / least_work);
  fmt::print("chosen: q = {:.3g}\n", trade.best(kLeastQ));
  return 0;
}

}  // namespace
}  // namespace turbid

int main(int argc, char** argv) {
  try {
    return turbid::run(argc, argv);
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
}
