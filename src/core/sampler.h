#pragma once
#include "core/rng.h"
#include "core/vector.h"

namespace turbid {

/// Which numbers a Sampler hands out.
enum class SamplerKind {
  kIndependent,  ///< uniform random numbers
  kSobol,        ///< padded 2D Sobol points with Owen scrambling, one scramble per pixel and dimension (Burley 2020)
};

/// The source of the numbers u in [0, 1) that one sample of one pixel consumes, in order.
///
/// A sample is named by (seed, pixel, index); its numbers depend on nothing else, so any sample can be replayed alone
/// and the work can be split over threads and processes in any way.
class Sampler {
 public:
  Sampler(SamplerKind kind, uint64_t seed) : kind_(kind), seed_(seed) {}

  /// Begins sample `index` of pixel `pixel` (any number that names it uniquely).
  void start(uint64_t pixel, uint64_t index) {
    rng_ = Rng(hash_counters(seed_, pixel, index));
    index_ = static_cast<uint32_t>(index);
    dimension_ = 0;
    if (kind_ == SamplerKind::kSobol) scramble_ = hash_counters(seed_, pixel);
  }

  float next_1d() { return kind_ == SamplerKind::kIndependent ? rng_.next_float() : sobol_1d(); }

  Vec2 next_2d() {
    if (kind_ != SamplerKind::kIndependent) return sobol_2d();
    const float u = rng_.next_float();
    return {u, rng_.next_float()};
  }

 private:
  float sobol_1d();
  Vec2 sobol_2d();

  /// Dimensions past this one are random: stratification of deep path vertices is not worth its cost.
  static constexpr uint32_t kSobolDimensions = 64;

  SamplerKind kind_;
  uint64_t seed_;
  Rng rng_;
  uint64_t scramble_ = 0;
  uint32_t index_ = 0, dimension_ = 0;
};

}  // namespace turbid
