#include "contests.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <numbers>

#include "image/image_file.h"
#include "image/metrics.h"
#include "methods.h"

namespace turbid::experiments {
namespace {

const std::string kOrderOne = ",min_scattering=1,max_scattering=1";
const std::string kIntervals = "singlescatter" + kOrderOne;
/// What is left of the noise under a lamp with a size is light that the boundary reflects inside before it scatters:
/// paths from both ends find that.
const std::string kIntervalsAndPaths = "bdpt,single_scattering=refractive" + kOrderOne;
const std::string kPoints = "singlescatter,method=point_sampling,samples=4" + kOrderOne;
constexpr uint64_t kSeed = 1, kReferenceSeed = 1000;

/// One of the two bodies, its light and what it is to be.
struct Subject {
  std::string name, file;
  std::array<double, 3> intensity;
  std::vector<std::string> definitions;

  Stage under_point(const std::string& scenes) const { return Stage(scenes + "/" + file, definitions); }

  /// Under a shining ball as bright as the point light.
  Stage under_ball(const std::string& scenes, double radius) const {
    std::vector<std::string> with_ball = definitions;
    with_ball.push_back("lamp=ball");
    with_ball.push_back(fmt::format("lamp_radius={}", radius));
    const double area = std::numbers::pi * radius * radius;
    with_ball.push_back(
        fmt::format("radiance={}, {}, {}", intensity[0] / area, intensity[1] / area, intensity[2] / area));
    return Stage(scenes + "/" + file, with_ball);
  }
};

Subject bumpy_ball(int size) {
  return {"bumpy ball of 5,120 triangles",
          "translucent_sphere.xml",
          {110, 105, 98},
          {"bumps=0.12", "subdivisions=4", fmt::format("res={}", size)}};
}

Subject statue(int size) {
  return {"statue of 10,000 triangles",
          "glass_statue.xml",
          {110, 105, 96},
          {"cell=0.06", fmt::format("width={}", size), fmt::format("height={}", size * 3 / 2)}};
}

struct Row {
  std::string name;
  uint32_t samples;
  Stage::Shot shot;
  ImageMetrics error;
};

/// Methods on one stage against one reference.
class Contest {
 public:
  Contest(std::string name, Stage stage, const ContestSettings& settings, const std::string& reference)
      : name_(std::move(name)),
        stage_(std::move(stage)),
        settings_(settings),
        reference_(stage_.render(reference, settings.reference_samples, kReferenceSeed).image) {
    keep("reference", reference_);
  }

  Row run(const std::string& name, const std::string& integrator, uint32_t samples) const {
    Row row{name, samples, stage_.render(integrator, samples, kSeed), {}};
    row.error = compare_images(color_channels(row.shot.image, name), color_channels(reference_, "reference"));
    keep(name, row.shot.image);
    return row;
  }

  /// With as many samples as take about that time, as one sample tells.
  Row run_for(const std::string& name, const std::string& integrator, double seconds) const {
    constexpr uint32_t kPilot = 2;
    const double one = stage_.render(integrator, kPilot, 77).seconds / kPilot;
    return run(name, integrator, static_cast<uint32_t>(std::max(1.0, std::round(seconds / one))));
  }

  double mean_of_reference() const { return mean_of(reference_); }

 private:
  void keep(const std::string& method, const Image& image) const {
    if (settings_.images.empty()) return;
    std::string file = name_ + " " + method;
    for (char& c : file)
      if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
    write_exr(settings_.images + "/" + file + ".exr", image);
    write_png(settings_.images + "/" + file + ".png", image);
  }

  std::string name_;
  Stage stage_;
  ContestSettings settings_;
  Image reference_;
};

void print_head(const std::string& title) {
  fmt::print(
      "\n{}\n\n| method | samples per pixel | CPU s | mean / reference | PSNR | behind by | MSE x s, relative |\n",
      title);
  fmt::print("| --- | --- | --- | --- | --- | --- | --- |\n");
}

double cost(const Row& row) { return row.error.rmse * row.error.rmse * row.shot.seconds; }

void print_row(const Row& row, const Row& first) {
  fmt::print("| {} | {} | {:.2f} | {:.3f} | {:.1f} dB | {:.1f} dB | {:.3g} |\n", row.name, row.samples,
             row.shot.seconds, row.error.mean_ratio, row.error.psnr, first.error.psnr - row.error.psnr,
             cost(row) / cost(first));
  std::fflush(stdout);
}

constexpr double kLampRadius = 0.1;

}  // namespace

void print_equal_time(const ContestSettings& settings, bool of_statue) {
  const Subject subject = of_statue ? statue(settings.size) : bumpy_ball(settings.size);
  const Contest point(subject.name + ", point light", subject.under_point(settings.scenes), settings, kIntervals);
  print_head(subject.name + ", point light, equal time");
  const Row intervals = point.run("triangle intervals", kIntervals, settings.samples);
  print_row(intervals, intervals);
  print_row(point.run("triangle intervals, midpoint", kIntervals + ",midpoint=true", settings.samples), intervals);
  print_row(point.run_for("point sampling", kPoints, intervals.shot.seconds), intervals);
  for (const char* photons : {"bre", "beams"})
    print_row(point.run_for(photons, photons + kOrderOne, intervals.shot.seconds), intervals);

  const Contest lamp(subject.name + ", lamp", subject.under_ball(settings.scenes, kLampRadius), settings,
                     kIntervalsAndPaths);
  print_head(fmt::format("{}, lamp of radius {}, equal time", subject.name, kLampRadius));
  const Row by_lamp = lamp.run("triangle intervals", kIntervals, settings.samples);
  print_row(by_lamp, by_lamp);
  print_row(lamp.run_for("triangle intervals, bdpt", kIntervalsAndPaths, by_lamp.shot.seconds), by_lamp);
  for (const char* other : {"bdpt", "volpath", "mcrt"})
    print_row(lamp.run_for(other, other + kOrderOne, by_lamp.shot.seconds), by_lamp);
}

void print_equal_quality(const ContestSettings& settings, double factor) {
  const Subject subject = bumpy_ball(settings.size);
  const Contest point(subject.name + ", point light", subject.under_point(settings.scenes), settings, kIntervals);
  print_head(fmt::format("{}, point light, others {} times as long", subject.name, factor));
  const Row intervals = point.run("triangle intervals", kIntervals, settings.samples);
  print_row(intervals, intervals);
  for (const int samples : {4, 16, 64})
    print_row(point.run_for(fmt::format("point sampling, {} points", samples),
                            fmt::format("singlescatter,method=point_sampling,samples={}", samples) + kOrderOne,
                            factor * intervals.shot.seconds),
              intervals);
  print_row(point.run_for("bre", "bre" + kOrderOne, factor * intervals.shot.seconds), intervals);

  const Contest lamp(subject.name + ", lamp", subject.under_ball(settings.scenes, kLampRadius), settings,
                     kIntervalsAndPaths);
  print_head(fmt::format("{}, lamp of radius {}, others {} times as long", subject.name, kLampRadius, factor));
  const Row by_lamp = lamp.run("triangle intervals", kIntervals, settings.samples);
  print_row(by_lamp, by_lamp);
  print_row(lamp.run_for("triangle intervals, bdpt", kIntervalsAndPaths, by_lamp.shot.seconds), by_lamp);
  for (const char* other : {"bdpt", "mcrt"})
    print_row(lamp.run_for(other, other + kOrderOne, factor * by_lamp.shot.seconds), by_lamp);
}

}  // namespace turbid::experiments
