#include "integrator/gather_pilot.h"

#include <fmt/format.h>

#include "core/log.h"

namespace turbid {
namespace {

constexpr uint64_t kPilotStream = 0x71;
constexpr double kHigh = 1, kLow = 0.25;  ///< not far apart: 1/q is the cost of an image

/// Enough samples in all to see the difference of the variances, and of each pixel to see a variance.
uint32_t image_count(const Scene& scene) {
  constexpr size_t kSamples = size_t{1} << 16;
  return static_cast<uint32_t>(std::clamp<size_t>(kSamples / pixel_count(scene.film()), 2, 256));
}

QObservation observe(const Scene& scene, const PathSettings& path, McrtSettings own, double q, uint64_t seed,
                     const StopFlag& stop) {
  own.chooses_q = false;
  own.gather.q = static_cast<float>(q);
  Mcrt integrator(path, own);
  integrator.prepare(scene, seed, stop);
  const double before = work_of(integrator.counters());
  Film film(scene.film().image_size());
  const uint32_t images = image_count(scene);
  integrator.render_pass(scene, {seed, 0, images}, film, stop);
  return {q, mean_variance(film), (work_of(integrator.counters()) - before) / images};
}

}  // namespace

double mean_variance(const Film& film) {
  const auto n = static_cast<double>(film.samples());
  double sum = 0;
  for (const PixelSums& pixel : film.pixels())
    for (int c = 0; c < kChannels; ++c) sum += std::max(0.0, pixel.squares[c] - sqr(pixel.radiance[c]) / n) / (n - 1);
  return sum / static_cast<double>(film.pixel_count() * kChannels);
}

/// In units of one nearest-hit cast, as timed once in rooms of fog.
double work_of(const Counters& counters) {
  const auto count = [&](const char* name) {
    const auto found = counters.find(name);
    return found == counters.end() ? 0.0 : static_cast<double>(found->second);
  };
  return count("rays") + 0.7 * count("shadow_rays") + 1.0 * count("volumes") + 0.5 * count("light_segments") +
         0.1 * count("volume_tests") + 0.3 * count("deposits") + 0.2 * count("connections") + 0.5 * count("photons") +
         1.0 * count("photon_beams") + 0.3 * count("point_queries") + 0.5 * count("beam_queries") +
         0.05 * count("point_tests") + 0.1 * count("beam_tests") + 0.2 * count("merges");
}

double QTradeOff::best(double least) const {
  if (!(variance_by_q > 0) || !(work > 0)) return 1;
  return std::clamp(std::sqrt(std::max(0.0, variance) * work_by_spheres / (variance_by_q * work)), least, 1.0);
}

QTradeOff trade_off(const QObservation& high, const QObservation& low) {
  QTradeOff result;
  result.variance_by_q = (high.variance - low.variance) / (high.q - low.q);
  result.variance = high.variance - result.variance_by_q * high.q;
  result.work_by_spheres = (low.work - high.work) / (1 / low.q - 1 / high.q);
  result.work = high.work - result.work_by_spheres / high.q;
  return result;
}

float choose_q(const Scene& scene, const PathSettings& path, const McrtSettings& own, uint64_t seed,
               const StopFlag& stop) {
  const uint64_t pilot_seed = hash_counters(seed, kPilotStream);
  const QTradeOff trade =
      trade_off(observe(scene, path, own, kHigh, pilot_seed, stop), observe(scene, path, own, kLow, pilot_seed, stop));
  if (stop.requested()) return 1;
  const double q = trade.best(kLeastQ);
  std::string curve;
  for (const double at : {1.0, 0.3, 0.1, 0.03, 0.01})
    curve += fmt::format("{}{:g}: {:.3g}", curve.empty() ? "" : ", ", at, trade.product(at) / trade.product(q));
  log_notice(
      fmt::format("q = {:.3g}, by variance {:.3g} + {:.3g} q times work {:.3g} + {:.3g} / q casts per image; "
                  "product by q, over the least: {}",
                  q, trade.variance, trade.variance_by_q, trade.work, trade.work_by_spheres, curve));
  return static_cast<float>(q);
}

}  // namespace turbid
