// S1 Table 2 and Fig. 27: methods with and without tables, PSNR over processor time, and how far the tables' light is
// off in the end. PSNR here has the 99th percentile of the reference as its peak: lamps that are in the picture do not
// raise it.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <filesystem>

#include "image/film_image.h"
#include "image/image_file.h"
#include "image/metrics.h"
#include "methods.h"
#include "render/statistics.h"

namespace turbid::experiments {
namespace {

struct Options {
  std::string scenes = "scenes";
  std::string keep;  ///< folder of the truths' pictures; empty: none is kept
  std::vector<std::string> methods;
  int size = 128;
  double seconds = 20, reference_seconds = 120;
  bool multiple = false;
};

struct Subject {
  std::string name, file;
  std::vector<std::string> definitions;
  std::string truth;  ///< the integrator that finds it
  std::string seed;   ///< what S1 Table 2 says
};

/// What is rendered pass by pass, and stopped by processor time.
class Run {
 public:
  Run(const Stage& stage, const std::string& integrator, uint64_t seed)
      : stage_(stage),
        integrator_(stage.make(integrator)),
        seed_(seed),
        film_(stage.scene().film().image_size(), integrator_->layer_names()) {
    integrator_->prepare(stage.scene(), seed, StopFlag());
  }

  /// Passes until they have taken so long in all, longer ones while they take little.
  void render_until(double seconds) {
    while (seconds_ < seconds) {
      const double begin = process_cpu_seconds();
      integrator_->render_pass(stage_.scene(), {seed_, samples_, count_}, film_, StopFlag());
      const double took = process_cpu_seconds() - begin;
      samples_ += count_;
      seconds_ += took;
      if (took < seconds / 16) count_ *= 2;
    }
  }
  uint64_t samples() const { return samples_; }
  Image image() const { return film_to_image(film_, false); }

 private:
  const Stage& stage_;
  std::shared_ptr<Integrator> integrator_;
  uint64_t seed_;
  Film film_;
  uint64_t samples_ = 0;
  uint32_t count_ = 1;
  double seconds_ = 0;
};

std::vector<double> values_of(const Image& image) {
  std::vector<double> values;
  for (const auto& channel : color_channels(image, "image"))
    for (const float value : channel) values.push_back(static_cast<double>(value));
  return values;
}

/// Two pictures of the truth, independent of each other.
struct Truth {
  std::vector<double> first, second, both;
  double peak = 0;  ///< 99th percentile

  Truth(const Image& a, const Image& b) : first(values_of(a)), second(values_of(b)) {
    for (size_t i = 0; i < first.size(); ++i) both.push_back((first[i] + second[i]) / 2);
    std::vector<double> sorted = both;
    std::sort(sorted.begin(), sorted.end());
    peak = sorted[sorted.size() * 99 / 100];
  }
  double decibels(double square) const { return 10 * std::log10(peak * peak / square); }
  /// Mean square of the difference; what the truth's own noise adds to it is taken off.
  double psnr(const Image& image) const {
    const std::vector<double> values = values_of(image);
    double sum = 0;
    for (size_t i = 0; i < values.size(); ++i) sum += (values[i] - first[i]) * (values[i] - second[i]);
    return decibels(std::max(sum / static_cast<double>(values.size()), 1e-12));
  }
  /// Where a biased method ends: two independent pictures' noise is not in the product of their differences.
  double cap(const Image& a, const Image& b) const {
    const std::vector<double> x = values_of(a), y = values_of(b);
    double sum = 0;
    for (size_t i = 0; i < x.size(); ++i) sum += (x[i] - first[i]) * (y[i] - second[i]);
    return decibels(std::max(sum / static_cast<double>(x.size()), 1e-12));
  }
  /// Of the mean of both: its own noise.
  double own_psnr() const {
    double sum = 0;
    for (size_t i = 0; i < first.size(); ++i) sum += (first[i] - second[i]) * (first[i] - second[i]) / 4;
    return decibels(std::max(sum / static_cast<double>(first.size()), 1e-12));
  }
  double mean_ratio(const Image& image) const {
    double sum = 0, all = 0;
    const std::vector<double> values = values_of(image);
    for (size_t i = 0; i < values.size(); ++i) sum += values[i], all += both[i];
    return sum / all;
  }
};

void measure(const Subject& subject, const Options& options) {
  const Stage stage(options.scenes + "/" + subject.file, subject.definitions);
  const std::string orders = options.multiple ? ",min_scattering=3" : "";
  const auto half = [&](uint64_t seed) {
    const std::string kept = options.keep.empty()
                                 ? ""
                                 : fmt::format("{}/{}_{}_{}_{}_{}.exr", options.keep, subject.name, options.size,
                                               options.multiple ? "multiple" : "all", options.reference_seconds, seed);
    if (!kept.empty() && std::filesystem::exists(kept)) return read_exr(kept);
    Run run(stage, subject.truth + orders, seed);
    run.render_until(options.reference_seconds / 2);
    if (!kept.empty()) write_exr(kept, run.image());
    return run.image();
  };
  const Image first = half(1001), second = half(1002);
  const Truth truth(first, second);
  fmt::print(
      "\n{}, {}; truth by {}, {:.4g} s, {:.1f} dB; S1: {}\n\n| method | {} | mean | cap, dB |\n| --- |{} --- | --- "
      "|\n",
      subject.name, options.multiple ? "orders from 3 on" : "all light", subject.truth, options.reference_seconds,
      truth.own_psnr(), subject.seed,
      [&] {
        std::string head;
        for (double t = options.seconds / 8; t <= options.seconds; t *= 2)
          head += fmt::format("{}{:.3g} s", head.empty() ? "" : " | ", t);
        return head;
      }(),
      " --- | --- | --- | --- |");
  for (const std::string& method : options.methods) {
    Run run(stage, method + orders, 1), other(stage, method + orders, 2);
    std::string cells;
    for (double t = options.seconds / 8; t <= options.seconds; t *= 2) {
      run.render_until(t);
      cells += fmt::format(" {:.1f} |", truth.psnr(run.image()));
    }
    std::string cap;
    if (method.find("table") != std::string::npos) {
      other.render_until(options.seconds);
      cap = fmt::format("{:.1f}", truth.cap(run.image(), other.image()));
    }
    fmt::print("| {} |{} {:.3f} | {} |\n", method, cells, truth.mean_ratio(run.image()), cap);
    std::fflush(stdout);
  }
}

}  // namespace

int run(int argc, char** argv) {
  Options options;
  CLI::App app(
      "Methods with tables of multiple scattering and without: PSNR over processor time (S1 Table 2, Fig. 27)");
  app.add_option("--scenes", options.scenes, "folder of the scenes");
  app.add_option("--keep", options.keep, "folder in which pictures of the truth stay, to be found again");
  app.add_option("--method", options.methods, "integrator, may be repeated");
  app.add_option("--size", options.size, "width of pictures");
  app.add_option("--seconds", options.seconds, "processor time of each method, all threads");
  app.add_option("--reference-seconds", options.reference_seconds, "processor time of the truth");
  app.add_flag("--multiple", options.multiple, "orders of scattering from 3 on alone");
  std::string scene;
  app.add_option("--scene", scene, "one of them by name; empty: all");
  CLI11_PARSE(app, argc, argv);
  if (options.methods.empty()) {
    const std::string table = ",multiple_scattering=table", upbp = "upbp,techniques=bpt+surf+pb2d";
    for (const std::string& method : {std::string("volpath"), std::string("vrl"), upbp})
      for (const std::string& kind : {std::string(), table, table + ",boundary=image", table + ",boundary=measured"})
        options.methods.push_back(method + kind);
  }
  const std::string ball = fmt::format("res={}", options.size);
  const std::vector<std::string> tall = {fmt::format("width={}", options.size),
                                         fmt::format("height={}", options.size * 5 / 4)};
  const auto with = [](std::vector<std::string> all, std::initializer_list<const char*> more) {
    all.insert(all.end(), more.begin(), more.end());
    return all;
  };
  const std::string ball_mark = "VRL 34.5 dB, UPBP 35.8 dB in 60 s";
  const std::string candle_mark = "VRL 37.4 dB, UPBP 37.3 dB in 120 s (another candle)";
  const std::vector<Subject> subjects = {
      {"ball_under_lamps", "bumpy_sphere.xml", {ball}, "volpath", ball_mark},
      {"ball_and_point", "bumpy_sphere.xml", {ball, "light=point"}, "bdpt", ball_mark},
      {"candle_under_lamps", "candle.xml", tall, "volpath", candle_mark},
      {"candle_and_bulb", "candle_with_ball.xml", with(tall, {"inside=nothing"}), "bdpt", candle_mark}};
  for (const Subject& subject : subjects)
    if (scene.empty() || subject.name == scene) measure(subject, options);
  return 0;
}

}  // namespace turbid::experiments
