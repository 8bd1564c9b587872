#include "integrator/particle_tracer.h"

#include <cmath>

#include "core/log.h"
#include "core/parallel.h"
#include "path/light_walk.h"

namespace turbid {
namespace {

constexpr size_t kGrain = 256;  ///< light paths per task

/// Joins the vertices of light paths with the sensor. `put(pixel, value)` takes what arrives.
template <class Put>
class SensorConnector {
 public:
  SensorConnector(const Scene& scene, const PathSettings& settings, double paths, Sampler& sampler,
                  SampleCounters& counters, const Put& put)
      : scene_(scene),
        settings_(settings),
        film_(scene.film()),
        crop_(film_.crop_size.x > 0 ? film_.crop_size : film_.size),
        // The mean over the film, times its pixels, is the integral over the film in units of pixels.
        scale_(static_cast<float>(static_cast<double>(film_.size.x) * static_cast<double>(film_.size.y) / paths)),
        sampler_(sampler),
        counters_(counters),
        put_(put) {}

  void at_emitter(const Emission& emission, const Traveller& traveller) {
    if (settings_.hide_emitters || settings_.min_scattering > 0) return;
    if (emission.emitter->is_environment()) {
      connect_sky(emission);
    } else if (emission.object) {
      connect_lamp(emission, traveller);
    }  // points and beams are not seen directly
  }

  void at_surface(const SurfaceEvent& event, const PathState& state, const Traveller& traveller) {
    if (!settings_.order_counts(state.order) || !(event.object.bsdf->flags() & lobe::kSmooth)) return;
    const SurfacePoint& point = event.point;
    const auto to_sensor = scene_.sensor().connect(point.p, sampler_.next_2d());
    if (!to_sensor) return;
    const Vec3 wo = normalize(to_sensor->position - point.p);
    const float correction = adjoint_correction(point, event.wi, wo);
    if (correction == 0) return;
    const Spectrum scattered =
        event.object.bsdf->eval(point, event.wi_local, point.to_local(wo), TransportMode::kImportance).value;
    connect(*to_sensor, point.leave(wo), state.throughput * scattered * correction, traveller, &event.object, &point);
  }

  void at_collision(const CollisionEvent& event, const PathState& state, const Traveller& traveller) {
    if (!settings_.order_counts(state.order)) return;
    const auto to_sensor = scene_.sensor().connect(event.position, sampler_.next_2d());
    if (!to_sensor) return;
    const Vec3 wo = normalize(to_sensor->position - event.position);
    const float scattered = event.medium.phase().eval(dot(event.direction, wo));
    connect(*to_sensor, event.position, state.throughput * scattered, traveller);
  }

 private:
  /// A surface that shines, seen directly. Lights with a surface shine alike in all directions of their outside: the
  /// radiance that the emitted ray stands for holds for the way to the sensor too.
  void connect_lamp(const Emission& emission, const Traveller& traveller) {
    const EmissionSample& ray = emission.ray;
    const auto to_sensor = scene_.sensor().connect(ray.origin, sampler_.next_2d());
    if (!to_sensor) return;
    const Vec3 wo = normalize(to_sensor->position - ray.origin);
    const float cosine = dot(ray.ng, wo), cosine_of_ray = dot(ray.ng, ray.direction);
    if (!(cosine > 0) || !(cosine_of_ray > 0)) return;
    connect(*to_sensor, ray.origin, emission.throughput * (ray.pdf_w / cosine_of_ray * cosine), traveller);
  }

  /// The sky behind everything: an edge from infinity.
  void connect_sky(const Emission& emission) {
    const Vec3 towards = -emission.ray.direction;
    const auto to_sensor = scene_.sensor().connect_to_infinity(towards, sampler_.next_2d());
    if (!to_sensor) return;
    const Spectrum radiance_per_pdf_w = emission.throughput * emission.ray.pdf_a;
    const auto target = target_of(*to_sensor);
    if (!target) return;
    Ray line{to_sensor->position + towards * to_sensor->near_t, towards, to_sensor->far_t - to_sensor->near_t};
    // Media without end stop at the end of the world, even if things are visible farther away.
    if (line.t_max >= scene_.distance_to_world_end(line)) line.t_max = kInfinity;
    Traveller from_sensor(scene_, true, sampler_, counters_);
    from_sensor.start(line, scene_.sensor_medium(), scene_.sensor_media());
    const Spectrum arrived = radiance_per_pdf_w * near_part(*to_sensor, towards);
    if (arrived.is_black()) return;
    finish(*target, arrived * from_sensor.look_along(line, arrived).transmittance * to_sensor->importance);
  }

  void connect(const SensorConnection& to_sensor, const Vec3& origin, const Spectrum& flux, const Traveller& traveller,
               const Object* object = nullptr, const SurfacePoint* point = nullptr) {
    if (flux.is_black()) return;
    const auto target = target_of(to_sensor);
    if (!target) return;
    const Vec3 way = to_sensor.position - origin;
    const float distance = length(way);
    const Vec3 wo = way / distance;
    const Spectrum arrived = flux * near_part(to_sensor, -wo);
    if (arrived.is_black()) return;
    // What stands nearer than the near plane is not there.
    const Ray line{origin, wo, distance - to_sensor.near_t};
    if (!(line.t_max > 0)) return;
    const Passage passage = traveller.look_along(line, arrived, object, point);
    if (passage.prob == 0) return;
    finish(*target, arrived * passage.transmittance * to_sensor.importance);
  }

  /// Attenuation between the sensor and its near plane.
  Spectrum near_part(const SensorConnection& to_sensor, const Vec3& direction) {
    const Medium* medium = to_sensor.near_t > 0 ? scene_.sensor_medium() : nullptr;
    if (!medium) return Spectrum(1.0f);
    return medium->transmittance({to_sensor.position, direction, to_sensor.near_t}, sampler_);
  }

  /// The pixel of the crop that a connection goes to, if any.
  std::optional<SplatTarget> target_of(const SensorConnection& to_sensor) {
    const Vec2 position(to_sensor.film.x * static_cast<float>(film_.size.x) - static_cast<float>(film_.crop_offset.x),
                        to_sensor.film.y * static_cast<float>(film_.size.y) - static_cast<float>(film_.crop_offset.y));
    const float support = film_.filter.support();
    const bool near = position.x >= -support && position.x <= static_cast<float>(crop_.x) + support &&
                      position.y >= -support && position.y <= static_cast<float>(crop_.y) + support;
    if (!near) return std::nullopt;
    const SplatTarget target = choose_pixel(film_.filter, position, sampler_.next_2d());
    const Vec2i& pixel = target.pixel;
    if (target.weight == 0 || pixel.x < 0 || pixel.y < 0 || pixel.x >= crop_.x || pixel.y >= crop_.y)
      return std::nullopt;
    return target;
  }

  void finish(const SplatTarget& target, const Spectrum& arrived) {
    const Spectrum value = arrived * (target.weight * scale_);
    if (!value.is_finite() || value.min() < 0) {
      ++counters_.dropped_samples;
    } else if (!value.is_black()) {
      put_(static_cast<size_t>(target.pixel.y) * static_cast<size_t>(crop_.x) + static_cast<size_t>(target.pixel.x),
           value);
    }
  }

  const Scene& scene_;
  const PathSettings& settings_;
  const FilmSettings& film_;
  const Vec2i crop_;
  const float scale_;
  Sampler& sampler_;
  SampleCounters& counters_;
  const Put& put_;
};

/// Keeps the streams of light paths apart from those of pixels.
constexpr uint64_t kLightStream = 0x6c69676874ull, kPilotStream = 0x70696c6f74ull;

/// Traces paths [0, count) of one sample index, side by side; `put` must bear many threads. `paths`: how many make one
/// sample of the film.
template <class Put>
SampleCounters trace(const Scene& scene, const LightSources& sources, const PathSettings& settings, uint64_t seed,
                     uint64_t sample, size_t count, double paths, const StopFlag& stop, const Put& put) {
  SampleCounters totals;
  std::mutex mutex;
  const size_t tasks = (count + kGrain - 1) / kGrain;
  parallel_for(tasks, [&](size_t task) {
    if (stop.requested()) return;
    SampleCounters counters;
    Sampler sampler(scene.sampler(), seed);
    SensorConnector connector(scene, settings, paths, sampler, counters, put);
    LightWalk walk(scene, sources, settings, sampler, counters, connector);
    for (size_t path = task * kGrain; path < std::min(count, (task + 1) * kGrain); ++path) {
      sampler.start(path, sample);
      walk.run();
    }
    const std::lock_guard lock(mutex);
    totals.add(counters);
  });
  return totals;
}

}  // namespace

void ParticleTracer::prepare(const Scene& scene, uint64_t seed, const StopFlag& stop) {
  sources_.emplace(scene, true);
  for (const Surroundings& m : scene.media())
    if (m.medium->emits())
      log_warning("ptracer does not follow the light of glowing media: it is missing in the picture");

  // The largest value does not depend on the order of threads; its exponent stays what it is for a resumed render.
  constexpr size_t kPilotPaths = 4096;
  constexpr uint64_t kMostRounds = 16;
  const size_t paths = Film(scene.film().crop_size.x > 0 ? scene.film().crop_size : scene.film().size).pixel_count();
  std::atomic<float> largest{0};
  for (uint64_t round = 0; round < kMostRounds && largest == 0 && !sources_->empty(); ++round) {
    trace(scene, *sources_, settings_, hash_counters(seed, kPilotStream), round, kPilotPaths,
          static_cast<double>(paths), stop, [&](size_t, const Spectrum& value) {
            float known = largest.load(std::memory_order_relaxed);
            while (value.max() > known && !largest.compare_exchange_weak(known, value.max())) {
            }
          });
  }
  largest_exponent_ = largest > 0 ? std::ilogb(largest.load()) + 1 : 0;
}

bool ParticleTracer::render_pass(const Scene& scene, const Pass& pass, Film& film, const StopFlag& stop) {
  SplatBuffer splats(film.size(), largest_exponent_);
  const auto put = [&](size_t pixel, const Spectrum& value) { splats.add(pixel, value); };
  for (uint64_t sample = pass.first_sample; sample < pass.first_sample + pass.sample_count; ++sample) {
    if (!sources_->empty())
      add_counters(trace(scene, *sources_, settings_, hash_counters(pass.seed, kLightStream), sample,
                         film.pixel_count(), static_cast<double>(film.pixel_count()), stop, put));
    if (stop.requested()) return false;
    for (size_t i = 0; i < film.pixel_count(); ++i) film.pixel(i).add(PixelSample{splats.sum(i)});
    splats.clear();
  }
  const std::lock_guard lock(mutex_);
  saturated_ += splats.saturated();
  film.add_samples(pass.sample_count);
  return true;
}

void ParticleTracer::add_counters(const SampleCounters& counters) {
  const std::lock_guard lock(mutex_);
  if (totals_.dropped_samples == 0 && counters.dropped_samples > 0)
    log_warning("dropped light that is not finite or negative; how often is in the statistics");
  totals_.add(counters);
}

Counters ParticleTracer::counters() const {
  const std::lock_guard lock(mutex_);
  return {{"light_paths", totals_.light_paths},   {"rays", totals_.rays},
          {"shadow_rays", totals_.shadow_rays},   {"collisions", totals_.collisions},
          {"free_flights", totals_.free_flights}, {"dropped_samples", totals_.dropped_samples},
          {"saturated_splats", saturated_}};
}

}  // namespace turbid
