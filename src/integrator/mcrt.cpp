#include "integrator/mcrt.h"

#include "core/parallel.h"
#include "integrator/camera_sample.h"
#include "integrator/gather_pilot.h"

namespace turbid {
namespace {

constexpr size_t kGrain = 64;       ///< pixels per task
constexpr size_t kBatch = 1 << 14;  ///< pixels between looks at the memory in use
constexpr size_t kIndexBytes = 96;  ///< of Embree's hierarchy, for each box

bool has_rough_surfaces(const Scene& scene) {
  return std::any_of(scene.objects().begin(), scene.objects().end(),
                     [](const Object& object) { return object.bsdf->flags() & lobe::kSmooth; });
}

}  // namespace

/// Hands a pixel what its walk from the sensor found, then traces its light paths.
class Mcrt::LightTracer final : public SplattingIntegrator::Worker {
 public:
  LightTracer(const Mcrt& owner, const Scene& scene, uint64_t seed, SampleCounters& counters)
      : owner_(owner),
        pixels_(pixel_count(scene.film())),
        sampler_(scene.sampler(), hash_counters(seed, kLightStream)),
        depositor_(*owner.plan_, owner.store_, static_cast<double>(pixels_) * owner.own_.light_paths, sampler_,
                   counters, deposits_),
        walk_(scene, owner.path_, sampler_, counters, depositor_) {}

  ~LightTracer() override {
    const std::lock_guard lock(owner_.counters_mutex_);
    owner_.deposits_.add(deposits_);
  }

  float run(size_t pixel, uint64_t index, ContributionSink& sink) override {
    if (owner_.last_round_)
      for (size_t i = pixel == 0 ? 0 : owner_.light_ends_[pixel - 1]; i < owner_.light_ends_[pixel]; ++i)
        sink.gather(owner_.light_[i].contribution);
    depositor_.begin(sink);
    if (!owner_.store_.volumes().empty() || !owner_.store_.disks().empty())
      for (size_t i = 0; i < owner_.paths_per_pixel_; ++i) {
        sampler_.start(pixel + i * pixels_, index);
        walk_.run(*owner_.sources_);
      }
    return owner_.alpha_[pixel];
  }

 private:
  const Mcrt& owner_;
  size_t pixels_;
  DepositCounters deposits_;
  Sampler sampler_;
  LightDepositor depositor_;
  LightWalk<LightDepositor> walk_;
};

std::unique_ptr<SplattingIntegrator::Worker> Mcrt::make_worker(const Scene& scene, uint64_t seed,
                                                               SampleCounters& counters) const {
  return std::make_unique<LightTracer>(*this, scene, seed, counters);
}

void Mcrt::prepare(const Scene& scene, uint64_t seed, const StopFlag& stop) {
  if (own_.chooses_q && !stop.requested()) own_.gather.q = choose_q(scene, path_, own_, seed, stop);
  // What the largest deposits are shows with few paths.
  paths_per_pixel_ = 1;
  SplattingIntegrator::prepare(scene, seed, stop);
  paths_per_pixel_ = static_cast<size_t>(own_.light_paths);
}

void Mcrt::prepare_workers(const Scene& scene) {
  sources_.emplace(scene, true);
  first_radius_ = own_.radius ? GatherRadius{*own_.radius, 0, 0} : radius_in_pixels(scene, own_.pixels);
  plan_.emplace(GatherPlan{scene, path_, own_.gather, first_radius_, first_radius_, has_rough_surfaces(scene)});
}

void Mcrt::set_radii(uint64_t index) {
  const bool balls = own_.gather.estimator == GatherSettings::Estimator::kCollision &&
                     own_.gather.volumes == GatherSettings::Volumes::kSpheres;
  plan_->volume_radius = first_radius_.scaled(radius_factor(index, own_.keep, balls ? 3 : 2));
  plan_->disk_radius = first_radius_.scaled(own_.disk_scale * radius_factor(index, own_.keep, 2));
}

bool Mcrt::prepare_round(const Scene& scene, uint64_t seed, uint64_t index, int round, const StopFlag& stop) {
  const size_t pixels = pixel_count(scene.film());
  if (round == 0) {
    set_radii(index);
    next_pixel_ = 0;
    light_.clear();
    light_ends_.assign(pixels, 0);
    alpha_.assign(pixels, 0);
  }
  Gathering& found = store_.found;
  found.volumes.clear();
  found.disks.clear();
  const auto fits = [&] {
    return found.bytes() + kIndexBytes * (found.volumes.size() + found.disks.size()) < own_.memory;
  };
  while (next_pixel_ < pixels && fits() && !stop.requested()) {
    const size_t to = std::min(next_pixel_ + kBatch, pixels);
    gather_pixels(scene, seed, index, next_pixel_, to, stop);
    next_pixel_ = to;
  }
  volumes_ += found.volumes.size();
  disks_ += found.disks.size();
  store_.index();
  last_round_ = next_pixel_ == pixels || stop.requested();
  return last_round_;
}

void Mcrt::gather_pixels(const Scene& scene, uint64_t seed, uint64_t index, size_t from, size_t to,
                         const StopFlag& stop) {
  const size_t width = static_cast<size_t>(scene.film().image_size().x);
  std::vector<Gathering> parts((to - from + kGrain - 1) / kGrain);
  parallel_for(parts.size(), [&](size_t task) {
    if (stop.requested()) return;
    SampleCounters counters;
    Sampler sampler(scene.sampler(), seed);
    SensorGatherer gatherer(*plan_, sampler, counters);
    CameraWalk<SensorGatherer> walk(scene, path_, sampler, counters, gatherer);
    for (size_t pixel = from + task * kGrain; pixel < std::min(to, from + (task + 1) * kGrain); ++pixel) {
      const Vec2i in_crop(static_cast<int>(pixel % width), static_cast<int>(pixel / width));
      const SensorRay camera = start_camera_sample(scene, in_crop + scene.film().crop_offset, index, sampler);
      gatherer.begin(static_cast<uint32_t>(pixel), camera, parts[task]);
      alpha_[pixel] = walk.run(camera);
      light_ends_[pixel] = parts[task].light.size();
      ++counters.camera_samples;
    }
    add_counters(counters);
  });
  for (size_t task = 0; task < parts.size(); ++task) {
    const size_t before = light_.size();
    for (size_t pixel = from + task * kGrain; pixel < std::min(to, from + (task + 1) * kGrain); ++pixel)
      light_ends_[pixel] += before;
    light_.insert(light_.end(), parts[task].light.begin(), parts[task].light.end());
    parts[task].light.clear();
    store_.found.append(parts[task]);
    parts[task] = {};
  }
}

Counters Mcrt::counters() const {
  Counters result = SplattingIntegrator::counters();
  const std::lock_guard lock(counters_mutex_);
  result["volumes"] = volumes_;
  result["disks"] = disks_;
  result["light_segments"] = deposits_.segments;
  result["volume_tests"] = deposits_.tests;
  result["deposits"] = deposits_.deposits;
  return result;
}

// --- what scene files say ------------------------------------------------------------------------------------------

namespace {

std::vector<Parameter> parameters() {
  return with_common_parameters(
      {word("volumes", "spheres",
            "what walks from the sensor leave in media: sphere (one at each collision), spheres (at null collisions, "
            "too), cylinder (around whole flights)",
            {"sphere", "spheres", "cylinder"}),
       {"q",
        ParameterType::kFloatOrString,
        "auto",
        "of spheres: the share of real collisions, in (0, 1], 1/q spheres per mean free path; auto: a pilot chooses",
        {.min = 0, .max = 1, .open_min = true}},
       word("estimator", "track", "light counts where it flies through a volume (track) or collides in it (collision)",
            {"track", "collision"}),
       word("cylinders", "long", "reach to the next surface (long) or end where the walk collides (short)",
            {"long", "short"}),
       word("segments", "short", "light counts until it collides (short) or to the next surface (long)",
            {"short", "long"}),
       {"radius", ParameterType::kFloat, "0", "of volumes in the first image, scene units; 0: by pixels", kNonNegative},
       {"pixels", ParameterType::kFloat, "1",
        "radius in widths of what a pixel covers at the distance, where radius is 0", kPositive},
       {"disk_scale", ParameterType::kFloat, "3", "radii of disks on surfaces, over those of volumes", kPositive},
       {"keep",
        ParameterType::kFloat,
        "0.6666667",
        "how much of each image's light the shrinking volumes keep, in (0, 1]; 1: radii stay",
        {.min = 0, .max = 1, .open_min = true}},
       {"collisions",
        ParameterType::kInteger,
        "1",
        "volumes stand at so many collisions of a walk, all but the last for light not scattered before; -1: no limit",
        {.min = -1}},
       word("surface_light", "surfaces",
            "where light is taken that rough surfaces scatter into media: at the surfaces that walks come to, or in "
            "volumes",
            {"surfaces", "volumes"}),
       word("surfaces", "disks", "light at surfaces is gathered in disks, or found by paths that go on",
            {"disks", "paths"}),
       {"light_paths", ParameterType::kInteger, "1", "light paths per pixel of each image", kAtLeastOne},
       {"memory", ParameterType::kInteger, "1024", "about the most memory for volumes, MiB", kAtLeastOne}});
}

McrtSettings settings_of(const Properties& properties) {
  McrtSettings own;
  GatherSettings& gather = own.gather;
  const std::string volumes = properties.string("volumes");
  if (volumes == "cylinder") gather.volumes = GatherSettings::Volumes::kCylinders;
  const bool chooses = properties.is_string("q");
  if (chooses && properties.string("q") != "auto") properties.refuse("q", "must be a number or 'auto'");
  own.chooses_q = chooses && volumes == "spheres";
  if (!chooses && volumes == "spheres") gather.q = properties.number("q");
  if (properties.string("estimator") == "collision") gather.estimator = GatherSettings::Estimator::kCollision;
  gather.long_cylinders = properties.string("cylinders") == "long";
  gather.long_segments = properties.string("segments") == "long";
  if (properties.number("radius") > 0) own.radius = properties.number("radius");
  own.pixels = properties.number("pixels");
  own.disk_scale = properties.number("disk_scale");
  own.keep = properties.number("keep");
  const int64_t collisions = properties.integer("collisions");
  if (collisions == 0) properties.refuse("collisions", "must be at least 1, or -1");
  gather.collisions = collisions < 0 ? PathSettings::kUnlimited
                                     : static_cast<int>(std::min<int64_t>(collisions, PathSettings::kUnlimited));
  gather.surface_light_in_volumes = properties.string("surface_light") == "volumes";
  gather.disks = properties.string("surfaces") == "disks";
  own.light_paths = static_cast<int>(std::min<int64_t>(properties.integer("light_paths"), 1 << 20));
  own.memory = static_cast<size_t>(properties.integer("memory")) << 20;
  return own;
}

}  // namespace

IntegratorPlugin mcrt_row() {
  return {
      "mcrt",
      {},
      "gathering volumes along walks from the sensor, filled by light paths: spheres, strings of spheres, cylinders",
      parameters(),
      [](const Properties& properties) {
        return IntegratorSetup{std::make_shared<Mcrt>(path_settings(properties), settings_of(properties)), false};
      }};
}

}  // namespace turbid
