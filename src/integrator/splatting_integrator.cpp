#include "integrator/splatting_integrator.h"

#include <fmt/format.h>

#include <atomic>
#include <cmath>
#include <map>

#include "core/log.h"
#include "core/parallel.h"

namespace turbid {
namespace {

constexpr size_t kGrain = 64;  ///< samples per task
constexpr uint64_t kPilotStream = 0x70696c6f74ull;

bool is_valid(const Spectrum& value) { return value.is_finite() && value.min() >= 0; }

void add_to(std::span<double> layers, size_t channel, const Spectrum& value) {
  for (int c = 0; c < kChannels; ++c) layers[channel + static_cast<size_t>(c)] += static_cast<double>(value[c]);
}

}  // namespace

/// Remembers the largest splat: it does not depend on the order of threads.
class SplattingIntegrator::PilotSink final : public ContributionSink {
 public:
  void gather(const Contribution&) override {}
  void splat(size_t, const Contribution& contribution) override {
    const float value = contribution.value.max() * contribution.weight;
    float known = largest_.load(std::memory_order_relaxed);
    while (value > known && std::isfinite(value) && !largest_.compare_exchange_weak(known, value)) {
    }
  }
  float largest() const { return largest_.load(); }

 private:
  std::atomic<float> largest_{0};
};

/// What is splatted in one sample of all pixels: the picture, and each layer on its own.
struct SplattingIntegrator::Splats {
  SplatBuffer picture;
  std::map<size_t, SplatBuffer> layers{};  ///< by the channel that each begins at
  std::optional<Cascades> cascades{};      ///< each splat is a sample of its own there
};

class SplattingIntegrator::PassSink final : public ContributionSink {
 public:
  PassSink(const SplattingIntegrator& owner, Film& film, Splats& splats, SampleCounters& counters)
      : owner_(owner), film_(film), splats_(splats), counters_(counters) {}

  void begin(size_t pixel) {
    pixel_ = pixel;
    sample_ = {};
  }
  /// Ends the pixel's sample. What was gathered for it is one sample of the cascades: its parts share a path and come
  /// together, so that many of them are no evidence for each other.
  const PixelSample& end() {
    if (splats_.cascades) splats_.cascades->add(film_.layers(pixel_), sample_.radiance);
    return sample_;
  }

  void gather(const Contribution& contribution) override {
    const Spectrum value = contribution.value * contribution.weight;
    if (drop(contribution, value)) return;
    sample_.radiance += value;
    const std::span<double> layers = film_.layers(pixel_);
    for_layers(contribution, value, [&](size_t channel, const Spectrum& part) { add_to(layers, channel, part); });
  }

  void splat(size_t pixel, const Contribution& contribution) override {
    const Spectrum value = contribution.value * contribution.weight;
    if (drop(contribution, value)) return;
    splats_.picture.add(pixel, value);
    if (splats_.cascades)
      for (const CascadeShare& share : splats_.cascades->split(value))
        splats_.layers.at(share.channel).add(pixel, share.value);
    for_layers(contribution, value,
               [&](size_t channel, const Spectrum& part) { splats_.layers.at(channel).add(pixel, part); });
  }

 private:
  /// A weight of 0 is no reason: what is shown without weights may be light.
  bool drop(const Contribution& contribution, const Spectrum& value) {
    if (is_valid(value)) return contribution.value.is_black();
    ++counters_.dropped_samples;
    return true;
  }

  template <class Add>
  void for_layers(const Contribution& contribution, const Spectrum& value, const Add& add) const {
    for (const OrderLayer& layer : owner_.order_layers_) {
      const int order = std::min(contribution.order, kOrderClasses - 1);
      if (order >= layer.min_order && order <= layer.max_order) add(layer.channel, value);
    }
    if (owner_.shows_techniques_) add(owner_.technique_channel(contribution.technique), value);
    if (contribution.technique != Technique::kJoin) return;
    if (const int layer = owner_.strategy_layer(contribution.light_vertices, contribution.edges()); layer >= 0) {
      add(static_cast<size_t>(layer) * kChannels, value);
      add(static_cast<size_t>(layer + 1) * kChannels, contribution.value);
    }
  }

  const SplattingIntegrator& owner_;
  Film& film_;
  Splats& splats_;
  SampleCounters& counters_;
  size_t pixel_ = 0;
  PixelSample sample_;
};

bool SplattingIntegrator::split_orders(const std::vector<OrderLayer>& layers) {
  order_layers_ = layers;
  return true;
}

// Layers go by edges k = 1, 2 ..., and for each by the number of light vertices, 0 ... k, in pairs.
int SplattingIntegrator::strategy_layer(int light_vertices, int edges) const {
  if (edges > shown_edges_) return -1;
  const int before = (edges - 1) * (edges + 2) / 2;  // sum over k < edges of k + 1
  return 2 * (before + light_vertices);
}

size_t SplattingIntegrator::technique_channel(Technique technique) const {
  const int strategies = shown_edges_ > 0 ? strategy_layer(shown_edges_, shown_edges_) + 2 : 0;
  return (static_cast<size_t>(strategies) + static_cast<size_t>(technique)) * kChannels;
}

std::vector<std::string> SplattingIntegrator::layer_names() const {
  std::vector<std::string> names;
  for (int edges = 1; edges <= shown_edges_; ++edges)
    for (int s = 0; s <= edges; ++s)
      for (const char* kind : {"weighted", "plain"})
        for (const char* channel : {"R", "G", "B"})
          names.push_back(fmt::format("strategy.{}.{}.{}.{}", kind, edges, s, channel));
  if (shows_techniques_)
    for (const char* technique : kTechniqueNames)
      for (const char* channel : {"R", "G", "B"}) names.push_back(fmt::format("technique.{}.{}", technique, channel));
  return names;
}

void SplattingIntegrator::prepare(const Scene& scene, uint64_t seed, const StopFlag& stop) {
  prepare_workers(scene);
  if (!splats()) return;
  // The exponent of the largest value stays what it is for a resumed render.
  constexpr size_t kPilotPaths = 4096;
  constexpr uint64_t kMostRounds = 16;
  const size_t pixels = pixel_count(scene.film());
  PilotSink sink;
  for (uint64_t round = 0; round < kMostRounds && sink.largest() == 0 && !scene.emitters().empty(); ++round) {
    const uint64_t pilot_seed = hash_counters(seed, kPilotStream);
    prepare_round(scene, pilot_seed, round, 0, stop);
    parallel_for((kPilotPaths + kGrain - 1) / kGrain, [&](size_t task) {
      if (stop.requested()) return;
      SampleCounters counters;
      const auto worker = make_worker(scene, pilot_seed, counters);
      for (size_t i = task * kGrain; i < std::min(kPilotPaths, (task + 1) * kGrain); ++i)
        worker->run(i % pixels, round + kMostRounds * (i / pixels), sink);
    });
  }
  largest_exponent_ = sink.largest() > 0 ? std::ilogb(sink.largest()) + 1 : 0;
}

bool SplattingIntegrator::render_pass(const Scene& scene, const Pass& pass, Film& film, const StopFlag& stop) {
  Splats splats{SplatBuffer(film.size(), largest_exponent_)};
  splats.cascades = Cascades::in(film, scene.film().outliers);
  for (size_t cascade = 0; splats.cascades && cascade < Cascades::kCount; ++cascade)
    splats.layers.try_emplace(splats.cascades->channel(cascade), film.size(), largest_exponent_);
  for (const OrderLayer& layer : order_layers_)
    splats.layers.try_emplace(layer.channel, film.size(), largest_exponent_);
  for (int edges = 1; edges <= shown_edges_; ++edges)
    for (int kind = 0; kind < 2; ++kind) {
      // Only what is joined with the sensor itself is splatted.
      const int layer = strategy_layer(edges, edges) + kind;
      splats.layers.try_emplace(static_cast<size_t>(layer) * kChannels, film.size(), largest_exponent_);
    }

  if (shows_techniques_) splats.layers.try_emplace(technique_channel(Technique::kJoin), film.size(), largest_exponent_);

  const size_t pixels = film.pixel_count();
  std::vector<PixelSample> gathered(pixels);
  for (uint64_t index = pass.first_sample; index < pass.first_sample + pass.sample_count; ++index) {
    bool last_round = false;
    for (int round = 0; !last_round; ++round) {
      last_round = prepare_round(scene, pass.seed, index, round, stop);
      parallel_for((pixels + kGrain - 1) / kGrain, [&](size_t task) {
        if (stop.requested()) return;
        SampleCounters counters;
        PassSink sink(*this, film, splats, counters);
        const auto worker = make_worker(scene, pass.seed, counters);
        for (size_t pixel = task * kGrain; pixel < std::min(pixels, (task + 1) * kGrain); ++pixel) {
          sink.begin(pixel);
          const float alpha = worker->run(pixel, index, sink);
          if (!last_round) continue;
          gathered[pixel] = sink.end();
          gathered[pixel].alpha = alpha;
        }
        add_counters(counters);
      });
      if (stop.requested()) return false;
    }
    for (size_t i = 0; i < pixels; ++i) {
      gathered[i].radiance += splats.picture.sum(i);
      film.pixel(i).add(gathered[i]);
      for (auto& [channel, buffer] : splats.layers) add_to(film.layers(i), channel, buffer.sum(i));
    }
    splats.picture.clear();
    for (auto& layer : splats.layers) layer.second.clear();
  }
  const std::lock_guard lock(mutex_);
  saturated_ += splats.picture.saturated();
  film.add_samples(pass.sample_count);
  return true;
}

void SplattingIntegrator::add_counters(const SampleCounters& counters) {
  const std::lock_guard lock(mutex_);
  if (totals_.dropped_samples == 0 && counters.dropped_samples > 0)
    log_warning("dropped light that is not finite or negative; how often is in the statistics");
  totals_.add(counters);
}

Counters SplattingIntegrator::counters() const {
  const std::lock_guard lock(mutex_);
  return {{"camera_samples", totals_.camera_samples},
          {"light_paths", totals_.light_paths},
          {"rays", totals_.rays},
          {"shadow_rays", totals_.shadow_rays},
          {"connections", totals_.connections},
          {"collisions", totals_.collisions},
          {"free_flights", totals_.free_flights},
          {"dropped_samples", totals_.dropped_samples},
          {"saturated_splats", saturated_}};
}

}  // namespace turbid
