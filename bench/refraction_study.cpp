#include "refraction_study.h"

#include <fmt/format.h>

#include <chrono>

#include "integrator/camera_sample.h"
#include "refraction/refractive_scattering.h"
#include "scene/loader.h"

namespace turbid::bench {
namespace {

/// A bumpy ball of glass with a point light behind it (S4 Fig. 1), seen by a camera that stands outside.
std::string ball_scene(int subdivisions, double sigma_t) {
  return fmt::format(R"(<scene version="3.0.0"><integrator type="volpath"/><sensor type="perspective">
    <float name="fov" value="34"/><transform name="to_world"><lookat origin="0.4, 1.1, 4.2" target="0, 0, 0"
    up="0, 1, 0"/></transform><film type="hdrfilm"><integer name="width" value="24"/><integer name="height" value="24"/>
    <rfilter type="box"/></film></sensor><emitter type="point"><point name="position" value="-1.3, 1.7, -1.9"/>
    <rgb name="intensity" value="90"/></emitter><shape type="generated"><string name="kind" value="bumpy_sphere"/>
    <float name="radius" value="1"/><float name="amplitude" value="0.12"/><float name="frequency" value="2.6"/>
    <integer name="subdivisions" value="{}"/><bsdf type="dielectric"><float name="int_ior" value="1.5"/>
    <float name="ext_ior" value="1"/></bsdf><medium name="interior" type="homogeneous">
    <rgb name="sigma_t" value="{}"/><rgb name="albedo" value="0.9"/></medium></shape></scene>)",
                     subdivisions, sigma_t);
}

/// The flights of the camera rays of all pixels through the ball, from where they are refracted into it.
class Flights {
 public:
  Flights(int subdivisions, double sigma_t)
      : loaded_(load_scene_from_string(ball_scene(subdivisions, sigma_t), "refraction study", {})),
        scene_(std::move(loaded_.parts)),
        medium_(scene_.media().front().medium) {
    Sampler sampler(SamplerKind::kIndependent, 1);
    const Vec2i size = scene_.film().image_size();
    for (int y = 0; y < size.y; ++y)
      for (int x = 0; x < size.x; ++x) add(start_camera_sample(scene_, {x, y}, 0, sampler).ray);
  }

  const Scene& scene() const { return scene_; }
  size_t size() const { return flights_.size(); }

  struct Rendering {
    std::vector<double> values;  ///< radiance of each flight
    double seconds_per_flight = 0;
  };
  /// One estimate of every flight; `index` names the random numbers.
  Rendering render(const RefractiveSettings& settings, uint64_t index, size_t stride = 1) const {
    const RefractiveScattering scattering(scene_, settings);
    Sampler sampler(SamplerKind::kIndependent, 7);
    SampleCounters counters;
    Rendering result;
    const auto start = std::chrono::steady_clock::now();
    for (size_t i = 0; i < flights_.size(); i += stride) {
      sampler.start(i, index);
      result.values.push_back(
          static_cast<double>(scattering.gather(flights_[i], *medium_, Spectrum(1.0f), sampler, counters).mean()));
    }
    result.seconds_per_flight = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() /
                                static_cast<double>(result.values.size());
    return result;
  }

 private:
  void add(const Ray& ray) {
    const Hit hit = scene_.rays().intersect(ray);
    if (!hit) return;
    const Object& object = scene_.object(hit);
    const SurfacePoint point = object.shape->surface_point(ray, hit);
    const auto bent = object.bsdf->sample(point, point.to_local(-ray.direction), kOneMinusEpsilon, Vec2(0.5f),
                                          TransportMode::kRadiance);
    if (!bent || !(bent->flags & lobe::kTransmission)) return;
    const Vec3 direction = point.to_world(bent->direction);
    Ray flight{point.leave(direction), direction};
    const Hit end = scene_.rays().intersect(flight);
    if (!end) return;
    flight.t_max = end.t;
    flights_.push_back(flight);
  }

  LoadedScene loaded_;
  Scene scene_;
  const Medium* medium_;
  std::vector<Ray> flights_;
};

double mean(const std::vector<double>& values) {
  double sum = 0;
  for (const double v : values) sum += v;
  return sum / static_cast<double>(values.size());
}

double mean_square_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (size_t i = 0; i < a.size(); ++i) sum += sqr(a[i] - b[i]);
  return sum / static_cast<double>(a.size());
}

void print_cost() {
  fmt::print("Cost of a camera ray, bumpy ball, point light\n{:>12}{:>16}{:>22}\n", "triangles", "us per ray",
             "tree bytes/triangle");
  double n = 0, sum_x = 0, sum_y = 0, sum_xx = 0, sum_xy = 0;
  for (const int subdivisions : {4, 5, 6, 7, 8}) {
    const Flights flights(subdivisions, 0.5);
    const RefractiveInterfaces interfaces(flights.scene());
    const PositionNormalTree& tree = interfaces.all().front().tree;
    const double seconds = flights.render({}, 0, 2).seconds_per_flight;
    const auto triangles = static_cast<double>(tree.triangle_count());
    fmt::print("{:>12}{:>16.1f}{:>22.1f}\n", tree.triangle_count(), 1e6 * seconds,
               static_cast<double>(tree.bytes()) / triangles);
    if (subdivisions < 5) continue;  // from 1e4 triangles on
    const double x = std::log(triangles), y = std::log(seconds);
    n += 1;
    sum_x += x;
    sum_y += y;
    sum_xx += x * x;
    sum_xy += x * y;
  }
  fmt::print("time grows as triangles^{:.2f}\n\n", (n * sum_xy - sum_x * sum_y) / (n * sum_xx - sum_x * sum_x));
}

void print_methods() {
  const Flights flights(4, 0.5);
  RefractiveSettings settings;
  settings.samples = 64;
  const std::vector<double> reference = flights.render(settings, 99).values;
  const double peak = *std::max_element(reference.begin(), reference.end());
  fmt::print("Noise, bumpy ball of 5120 triangles, {} camera rays\n{:<32}{:>14}{:>12}{:>12}{:>22}\n", flights.size(),
             "method", "us per ray", "mean", "PSNR (dB)", "MSE x time, relative");
  double first = 0;
  const auto show = [&](const std::string& name, const RefractiveSettings& chosen) {
    const Flights::Rendering r = flights.render(chosen, 1);
    const double error = mean_square_difference(r.values, reference), cost = error * r.seconds_per_flight;
    if (first == 0) first = cost;
    fmt::print("{:<32}{:>14.1f}{:>12.5f}{:>12.1f}{:>22.1f}\n", name, 1e6 * r.seconds_per_flight, mean(r.values),
               10 * std::log10(sqr(peak) / error), cost / first);
  };
  show("triangle_intervals", {});
  show("triangle_intervals, midpoint", {.in_middle = true});
  for (const int samples : {4, 16, 64, 256})
    show(fmt::format("point_sampling, {} points", samples),
         {.method = RefractiveMethod::kPointSampling, .samples = samples});
  fmt::print("reference (64 samples per interval): mean {:.5f}\n\n", mean(reference));
}

void print_shortcuts() {
  fmt::print("Shortcuts against the right radiance\n{:<40}{:>14}{:>26}\n", "", "mean ratio",
             "RMS error / RMS radiance");
  const auto show = [&](const std::string& name, const Flights& flights, const RefractiveSettings& shortcut) {
    const std::vector<double> right = flights.render({.samples = 4}, 3).values,
                              wrong = flights.render(shortcut, 4).values;
    const std::vector<double> zero(right.size());
    fmt::print("{:<40}{:>14.3f}{:>26.3f}\n", name, mean(wrong) / mean(right),
               std::sqrt(mean_square_difference(wrong, right) / mean_square_difference(right, zero)));
  };
  show("without D (distance squared)", Flights(4, 0.5), {.samples = 4, .focusing = false});
  for (const double sigma_t : {0.2, 1.0, 5.0, 20.0})
    show(fmt::format("straight line, {:g} mean free paths wide", 2 * sigma_t), Flights(4, sigma_t),
         {.method = RefractiveMethod::kStraightLine, .samples = 2048});
}

}  // namespace

void print_refraction_study() {
  print_cost();
  print_methods();
  print_shortcuts();
}

}  // namespace turbid::bench
