#include "integrator/sampling_integrator.h"

#include <fmt/format.h>

#include "core/log.h"
#include "core/parallel.h"
#include "integrator/camera_sample.h"

namespace turbid {
namespace {

constexpr int kTileSize = 16;

bool is_valid(const Spectrum& radiance) { return radiance.is_finite() && radiance.min() >= 0; }

}  // namespace

Counters SamplingIntegrator::counters() const {
  const std::lock_guard lock(mutex_);
  Counters result = {{"camera_samples", totals_.camera_samples}, {"rays", totals_.rays},
                     {"shadow_rays", totals_.shadow_rays},       {"collisions", totals_.collisions},
                     {"free_flights", totals_.free_flights},     {"dropped_samples", totals_.dropped_samples}};
  if (totals_.refractive_paths + totals_.unresolved_triangles > 0) {
    result["refractive_paths"] = totals_.refractive_paths;
    result["unresolved_triangles"] = totals_.unresolved_triangles;
  }
  return result;
}

void SamplingIntegrator::add_counters(const SampleCounters& counters) {
  const std::lock_guard lock(mutex_);
  totals_.add(counters);
}

bool SamplingIntegrator::split_orders(const std::vector<OrderLayer>& layers) {
  order_layers_ = layers;
  return true;
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
    add_counters(counters);
  });
  if (stop.requested()) return false;
  film.add_samples(pass.sample_count);
  return true;
}

void SamplingIntegrator::render_tile(const Scene& scene, const Pass& pass, const Vec2i& from, const Vec2i& to,
                                     Film& film, SampleCounters& counters, const StopFlag& stop) const {
  Sampler sampler(scene.sampler(), pass.seed);
  const std::optional<Cascades> cascades = Cascades::in(film, scene.film().outliers);
  for (int y = from.y; y < to.y; ++y) {
    for (int x = from.x; x < to.x; ++x) {
      if (stop.requested()) return;
      const Vec2i on_film = Vec2i(x, y) + scene.film().crop_offset;
      const size_t pixel = static_cast<size_t>(y) * static_cast<size_t>(film.size().x) + static_cast<size_t>(x);
      const std::span<double> layers = film.layers(pixel);
      PixelSums sums;
      for (uint64_t i = pass.first_sample; i < pass.first_sample + pass.sample_count; ++i) {
        const SensorRay camera = start_camera_sample(scene, on_film, i, sampler);
        const PixelSample sample = sample_radiance(scene, camera, sampler, counters);
        if (is_valid(sample.radiance)) {
          sums.add(sample);
          if (cascades) cascades->add(layers, sample.radiance);
          for (const OrderLayer& layer : order_layers_)
            for (int order = layer.min_order; order <= layer.max_order; ++order)
              for (int c = 0; c < kChannels; ++c)
                layers[layer.channel + static_cast<size_t>(c)] += static_cast<double>(sample.by_order[order][c]);
        } else if (++counters.dropped_samples == 1) {
          report_bad_sample(sample, on_film, pass, i);
        }
      }
      film.pixel(pixel).add(sums);
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
