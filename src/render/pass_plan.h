#pragma once
#include <cstdint>
#include <optional>

#include "core/vector.h"
#include "integrator/integrator.h"

namespace turbid {

/// Samples per pixel of every pass of a render: a power of two from 1 to 64 that makes about half a million samples. It
/// depends on the size of the image alone, so that pass k covers the same samples whatever the budget, the machine or
/// the number of threads, and a resumed render adds up the same numbers in the same order.
uint32_t samples_per_pass(const Vec2i& size);

/// When a render ends. Nothing set: never.
struct Budget {
  std::optional<uint64_t> samples{};  ///< per pixel, reached exactly
  std::optional<uint64_t> passes{};   ///< whole ones, counted from the beginning of the image
  std::optional<double> seconds{};    ///< of wall time, of this run; at least one pass is made
};

/// The sequence of passes of a render.
class PassPlan {
 public:
  PassPlan(const Vec2i& size, const Budget& budget, uint64_t seed);
  /// Passes that grow with what there is, whatever the size of the image: they begin with a sample per pixel and cover
  /// at most a thirty-second of the samples before them. Whoever has to stop at a time comes close to it with slow
  /// integrators and with fast ones.
  static PassPlan growing(const Budget& budget, uint64_t seed);

  /// Whole passes end at multiples of this.
  uint32_t samples_per_pass() const { return grows_ ? 1 : per_pass_; }
  /// Samples per pixel at the end, when that is known beforehand.
  std::optional<uint64_t> target() const { return target_; }
  /// The pass that follows after `samples` whole samples per pixel; empty at the end. Shorter than the others when the
  /// budget ends inside it.
  std::optional<Pass> next(uint64_t samples) const;

 private:
  uint32_t per_pass_;
  bool grows_ = false;
  uint64_t seed_;
  std::optional<uint64_t> target_;
};

}  // namespace turbid
