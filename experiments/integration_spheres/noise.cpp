// Noise and time of gathering volumes on one scene: spheres for q from 1 to 0.01, the q that the pilot chooses, and
// cylinders. Prints, for each, the variance of an image (mean over pixels and channels), its processor time, its
// counted work, and their products over the least; and what the compound Poisson analysis (docs/integration-spheres.md)
// says from q = 1 and q = 0.1 alone. All kinds take turns, so that a machine that is slow for a while is slow for all.
#include <fmt/format.h>

#include <CLI/CLI.hpp>

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

int run(int argc, char** argv) {
  CLI::App app("Noise and time of gathering volumes");
  std::string file;
  uint32_t images = 2;
  int rounds = 4;
  std::vector<std::string> definitions, extra;
  app.add_option("scene", file)->required();
  app.add_option("--images", images, "of each kind in a round")->check(CLI::PositiveNumber);
  app.add_option("--rounds", rounds, "in which all kinds take their turns")->check(CLI::PositiveNumber);
  app.add_option("-D", definitions, "name=value of the scene");
  app.add_option("--set", extra, "key=value of the integrator");
  CLI11_PARSE(app, argc, argv);
  set_log_level(LogLevel::kQuiet);
  const Stage stage(file, definitions);
  std::string settings;
  for (const std::string& text : extra) settings += "," + text;

  std::vector<Row> rows;
  for (const double q : {1.0, 0.5, 0.3, 0.2, 0.1, 0.05, 0.03, 0.02, 0.01})
    rows.emplace_back(stage, fmt::format("q = {}", q), fmt::format("{},q={}", settings, q));
  const size_t spheres = rows.size();
  rows.emplace_back(stage, "auto", settings + ",q=auto");
  for (const char* kind : {"short", "long"})
    rows.emplace_back(stage, fmt::format("{} cylinders", kind),
                      fmt::format("{},volumes=cylinder,cylinders={}", settings, kind));
  for (int round = 0; round < rounds; ++round)
    for (Row& row : rows) row.render(images);

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
  return 0;
}

}  // namespace
}  // namespace turbid::experiments

int main(int argc, char** argv) {
  try {
    return turbid::experiments::run(argc, argv);
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
}
