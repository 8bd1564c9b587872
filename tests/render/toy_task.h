#pragma once
#include <atomic>
#include <functional>
#include <memory>

#include "core/parallel.h"
#include "core/rng.h"
#include "render/render_job.h"

namespace turbid::testing {

inline const std::vector<std::string> kLayers = {"half.X", "twice.Y"};

/// A task whose samples are random numbers named by (seed, pixel, sample), as an integrator's are. `on_pass` is called
/// in the middle of every pass with the number of passes begun before it.
struct ToyTask {
  Vec2i size{100, 80};
  std::function<void(uint64_t)> on_pass{};
  std::shared_ptr<std::atomic<uint64_t>> begun = std::make_shared<std::atomic<uint64_t>>(0);

  RenderTask task() const {
    return {
        size, [](uint64_t, const StopFlag&) {},
        [toy = *this](const Pass& pass, Film& film, const StopFlag& stop) { return toy.render_pass(pass, film, stop); },
        [] {
          return Counters{{"rays", 7}, {"dropped_samples", 1}};
        },
        kLayers};
  }

  bool render_pass(const Pass& pass, Film& film, const StopFlag& stop) const {
    const uint64_t index = begun->fetch_add(1);
    parallel_for(film.pixel_count(), [&](size_t i) {
      if (i == film.pixel_count() / 2 && on_pass) on_pass(index);
      PixelSums sums;
      for (uint64_t s = pass.first_sample; s < pass.first_sample + pass.sample_count; ++s) {
        Rng rng(hash_counters(pass.seed, i, s));
        const float r = rng.next_float(), g = rng.next_float();
        sums.add({Spectrum(r * r * 1e3f, g, r * g), r});
      }
      film.pixel(i).add(sums);
      film.layers(i)[0] += sums.alpha / 2;
      film.layers(i)[1] += sums.alpha * 2;
    });
    if (stop.requested()) return false;
    film.add_samples(pass.sample_count);
    return true;
  }
};

inline bool same_bits(const Film& a, const Film& b) {
  return a.size() == b.size() && a.samples() == b.samples() && a.layer_names() == b.layer_names() &&
         std::memcmp(a.layers().data(), b.layers().data(), a.layers().size_bytes()) == 0 &&
         std::memcmp(a.pixels().data(), b.pixels().data(), a.pixels().size_bytes()) == 0;
}

}  // namespace turbid::testing
