#include "integrator/sampling_integrator.h"

#include <fmt/format.h>

#include "core/log.h"
#include "core/parallel.h"

namespace turbid {
namespace {

constexpr int kTileSize = 16;

bool is_valid(const Spectrum& radiance) { return radiance.is_finite() && radiance.min() >= 0; }

}  // namespace

void SampleCounters::add(const SampleCounters& other) {
  camera_samples += other.camera_samples;
  rays += other.rays;
  shadow_rays += other.shadow_rays;
  collisions += other.collisions;
  free_flights += other.free_flights;
  dropped_samples += other.dropped_samples;
}

Counters SamplingIntegrator::counters() const {
  const std::lock_guard lock(mutex_);
  return {{"camera_samples", totals_.camera_samples}, {"rays", totals_.rays},
          {"shadow_rays", totals_.shadow_rays},       {"collisions", totals_.collisions},
          {"free_flights", totals_.free_flights},     {"dropped_samples", totals_.dropped_samples}};
}

bool SamplingIntegrator::render_pass(const Scene& scene, const Pass& pass, Film& film, const StopFlag& stop) {
  const Vec2i size = film.size();
  const int columns = (size.x + kTileSize - 1) / kTileSize, rows = (size.y + kTileSize - 1) / kTileSize;
  parallel_for(static_cast<size_t>(columns) * static_cast<size_t>(rows), [&](size_t tile) {
    if (stop.requested()) return;
    const Vec2i from{static_cast<int>(tile) % columns * kTileSize, static_cast<int>(tile) / columns * kTileSize};
    const Vec2i to{std::min(from.x + kTileSize, size.x), std::min(from.y + kTileSize, size.y)};
    SampleCounters counters;
    render_tile(scene, pass, from, to, film, counters, stop);
    const std::lock_guard lock(mutex_);
    totals_.add(counters);
  });
  if (stop.requested()) return false;
  film.add_samples(pass.sample_count);
  return true;
}

void SamplingIntegrator::render_tile(const Scene& scene, const Pass& pass, const Vec2i& from, const Vec2i& to,
                                     Film& film, SampleCounters& counters, const StopFlag& stop) const {
  const FilmSettings& settings = scene.film();
  const Sensor& sensor = scene.sensor();
  const bool needs_aperture = sensor.needs_aperture();
  const Vec2 scale{1 / static_cast<float>(settings.size.x), 1 / static_cast<float>(settings.size.y)};
  Sampler sampler(scene.sampler(), pass.seed);
  for (int y = from.y; y < to.y; ++y) {
    for (int x = from.x; x < to.x; ++x) {
      if (stop.requested()) return;
      const Vec2i on_film = Vec2i(x, y) + settings.crop_offset;
      const Vec2 center{static_cast<float>(on_film.x) + 0.5f, static_cast<float>(on_film.y) + 0.5f};
      // Named by its place on the whole film, so that a crop shows the same samples as the full image.
      const auto pixel_name = static_cast<uint64_t>(on_film.y) << 32 | static_cast<uint64_t>(on_film.x);
      PixelSums sums;
      for (uint64_t i = pass.first_sample; i < pass.first_sample + pass.sample_count; ++i) {
        sampler.start(pixel_name, i);
        const Vec2 position = (center + settings.filter.sample(sampler.next_2d())) * scale;
        const SensorRay camera = sensor.sample_ray(position, needs_aperture ? sampler.next_2d() : Vec2(0.5f));
        const PixelSample sample = sample_radiance(scene, camera, sampler, counters);
        if (is_valid(sample.radiance)) {
          sums.add(sample);
        } else if (++counters.dropped_samples == 1) {
          report_bad_sample(sample, on_film, pass, i);
        }
      }
      film.pixel(static_cast<size_t>(y) * static_cast<size_t>(film.size().x) + static_cast<size_t>(x)).add(sums);
      counters.camera_samples += pass.sample_count;
    }
  }
}

void SamplingIntegrator::report_bad_sample(const PixelSample& sample, const Vec2i& pixel, const Pass& pass,
                                           uint64_t index) const {
  {
    const std::lock_guard lock(mutex_);
    if (totals_.dropped_samples > 0) return;  // one report is enough; the rest is counted
  }
  log_warning(fmt::format("dropped a sample with radiance ({}, {}, {}): pixel ({}, {}), sample {}, seed {}",
                          sample.radiance[0], sample.radiance[1], sample.radiance[2], pixel.x, pixel.y, index,
                          pass.seed));
}

}  // namespace turbid
