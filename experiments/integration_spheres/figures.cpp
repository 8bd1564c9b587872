// Gathering volumes on one scene (docs/integration-spheres.md).
//
// noise: spheres for q from 1 to 0.01, the q that the pilot chooses, and cylinders. Prints, for each, the variance of
// an image (mean over pixels and channels), its processor time, its counted work, and their products over the least;
// and what the compound Poisson analysis says from q = 1 and q = 0.1 alone. All kinds take turns, so that a machine
// that is slow for a while is slow for all.
//
// bias: how much light the whole image lacks at each of some fixed radii, beside what another integrator finds, and the
// slope from one radius to the next.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>

#include "core/log.h"
#include "integrator/gather_pilot.h"
#include "methods.h"
#include "render/statistics.h"

namespace turbid::experiments {
namespace {

constexpr uint64_t kSeed = 3;

class Row {
 public:
  Row(const Stage& stage, std::string name, const std::string& settings)
      : name_(std::move(name)),
        scene_(&stage.scene()),
        integrator_(std::dynamic_pointer_cast<Mcrt>(stage.make("mcrt,keep=1" + settings))),  // keep=1: images alike
        film_(scene_->film().image_size()) {
    const double begin = process_cpu_seconds();
    integrator_->prepare(*scene_, kSeed, StopFlag());
    preparation_ = process_cpu_seconds() - begin;
    idle_work_ = work_of(integrator_->counters());
  }

  void render(uint32_t images) {
    const double begin = process_cpu_seconds();
    integrator_->render_pass(*scene_, {kSeed, images_, images}, film_, StopFlag());
    seconds_.push_back((process_cpu_seconds() - begin) / images);
    images_ += images;
  }

  const std::string& name() const { return name_; }
  double q() const { return static_cast<double>(integrator_->q()); }
  double variance() const { return mean_variance(film_); }
  double seconds() const { return median(seconds_); }  ///< of an image
  double work() const { return (work_of(integrator_->counters()) - idle_work_) / static_cast<double>(images_); }
  double preparation() const { return preparation_; }  ///< seconds

 private:
  std::string name_;
  const Scene* scene_;
  std::shared_ptr<Mcrt> integrator_;
  Film film_;
  double preparation_, idle_work_;
  uint64_t images_ = 0;
  std::vector<double> seconds_;
};

struct Options {
  std::string file;
  std::vector<std::string> definitions, extra;
  uint32_t images = 2;
  int rounds = 4;
  std::vector<double> radii;
  std::string reference = "volpath";
  uint32_t reference_samples = 1024, samples = 128;

  std::string settings() const {
    std::string result;
    for (const std::string& text : extra) result += "," + text;
    return result;
  }
};

void print_noise(const Options& options) {
  const Stage stage(options.file, options.definitions);
  const std::string settings = options.settings();

  std::vector<Row> rows;
  for (const double q : {1.0, 0.5, 0.3, 0.2, 0.1, 0.05, 0.03, 0.02, 0.01})
    rows.emplace_back(stage, fmt::format("q = {}", q), fmt::format("{},q={}", settings, q));
  const size_t spheres = rows.size();
  rows.emplace_back(stage, "auto", settings + ",q=auto");
  for (const char* kind : {"short", "long"})
    rows.emplace_back(stage, fmt::format("{} cylinders", kind),
                      fmt::format("{},volumes=cylinder,cylinders={}", settings, kind));
  for (int round = 0; round < options.rounds; ++round)
    for (Row& row : rows) row.render(options.images);

  const auto at = [&](double q) -> const Row& {
    return *std::find_if(rows.begin(), rows.end(), [&](const Row& r) { return std::abs(r.q() - q) < 1e-6; });
  };
  const QTradeOff trade = trade_off({1, at(1).variance(), at(1).work()}, {0.1, at(0.1).variance(), at(0.1).work()});
  const auto least = [&](double (*value)(const Row&)) {
    double result = value(rows.front());
    for (const Row& row : rows) result = std::min(result, value(row));
    return result;
  };
  const auto by_time = [](const Row& r) { return r.variance() * r.seconds(); };
  const auto by_work = [](const Row& r) { return r.variance() * r.work(); };
  const double least_time = least(by_time), least_work = least(by_work);
  fmt::print(
      "| volumes | variance | predicted | CPU s per image | work, casts | variance x time | variance x work |\n");
  fmt::print("| --- | --- | --- | --- | --- | --- | --- |\n");
  for (size_t i = 0; i < rows.size(); ++i) {
    const Row& row = rows[i];
    fmt::print("| {} | {:.4g} | {} | {:.3f} | {:.3g} | {:.2f} | {:.2f} |\n", row.name(), row.variance(),
               i <= spheres ? fmt::format("{:.4g}", trade.variance + trade.variance_by_q * row.q()) : "", row.seconds(),
               row.work(), by_time(row) / least_time, by_work(row) / least_work);
  }
  fmt::print("auto: q = {:.3g}, for {:.1f} s of pilot; by these images it were {:.3g}\n", rows[spheres].q(),
             rows[spheres].preparation(), trade.best(kLeastQ));
}

struct Light {
  double mean, error;
};
Light measure_light(const Stage& stage, const std::string& integrator, uint32_t samples) {
  constexpr int kSeeds = 8;
  double sum = 0, squares = 0;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    const double mean = mean_of(stage.render(integrator, samples / kSeeds, static_cast<uint64_t>(seed)).image);
    sum += mean;
    squares += mean * mean;
  }
  const double mean = sum / kSeeds;
  return {mean, std::sqrt(std::max(0.0, squares / kSeeds - mean * mean) / (kSeeds - 1))};
}

void print_bias(const Options& options) {
  const Stage stage(options.file, options.definitions);
  const Light reference = measure_light(stage, options.reference, options.reference_samples);
  fmt::print("| radius | light over that of {} (± {:.5f}) | ± | slope |\n", options.reference,
             reference.error / reference.mean);
  fmt::print("| --- | --- | --- | --- |\n");
  double last_radius = 0, last_bias = 0;
  for (const double radius : options.radii) {
    const Light light = measure_light(
        stage, fmt::format("mcrt,keep=1,disk_scale=1,radius={}{}", radius, options.settings()), options.samples);
    const double bias = light.mean / reference.mean - 1;
    fmt::print(
        "| {:g} | {:.5f} | {:.5f} | {} |\n", radius, 1 + bias, light.error / reference.mean,
        last_radius > 0 ? fmt::format("{:.2f}", std::log(last_bias / bias) / std::log(last_radius / radius)) : "");
    last_radius = radius;
    last_bias = bias;
  }
}

}  // namespace

int run(int argc, char** argv) {
  CLI::App app("Gathering volumes: noise and bias");
  Options options;
  const auto common = [&](CLI::App* command) {
    command->add_option("scene", options.file)->required();
    command->add_option("-D", options.definitions, "name=value of the scene");
    command->add_option("--set", options.extra, "key=value of the integrator");
    return command;
  };
  CLI::App* noise = common(app.add_subcommand("noise", "variance, time and work by q, and of cylinders"));
  noise->add_option("--images", options.images, "of each kind in a round")->check(CLI::PositiveNumber);
  noise->add_option("--rounds", options.rounds, "in which all kinds take their turns")->check(CLI::PositiveNumber);
  CLI::App* bias = common(app.add_subcommand("bias", "the light of whole images by radius"));
  bias->add_option("--radius", options.radii, "scene units, the largest first")->required();
  bias->add_option("--samples", options.samples, "per pixel, at each radius")->check(CLI::Range(8u, 1u << 20));
  bias->add_option("--reference", options.reference, "an integrator");
  bias->add_option("--reference-samples", options.reference_samples)->check(CLI::Range(8u, 1u << 20));
  app.require_subcommand(1);
  CLI11_PARSE(app, argc, argv);
  set_log_level(LogLevel::kQuiet);
  noise->parsed() ? print_noise(options) : print_bias(options);
  return 0;
}

}  // namespace turbid::experiments
