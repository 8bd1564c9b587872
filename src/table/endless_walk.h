#pragma once
#include <vector>

#include "core/rng.h"
#include "core/vector.h"
#include "medium/phase_function.h"

namespace turbid {

/// A random walk without end in an infinite, homogeneous medium that absorbs nothing; mean free path 1. The medium
/// looks the same from everywhere, so every pair of its collisions (i, i + k) is a sample of k flights after a
/// collision that was reached along the direction into i. Keeps the last collisions only.
class EndlessWalk {
 public:
  struct Collision {
    Imath::V3d position;
    Vec3 direction;  ///< of the flight that ended here
  };

  /// Keeps `reach` collisions before the latest.
  EndlessWalk(const PhaseFunction& phase, size_t reach, uint64_t seed);

  /// One scattering and one flight; four words of the random stream at most.
  void step();
  /// The collision `lag` before the latest, lag <= reach.
  const Collision& back(size_t lag) const { return ring_[(latest_ - lag) & mask_]; }
  Rng& rng() { return rng_; }

 private:
  const PhaseFunction& phase_;
  Rng rng_;
  std::vector<Collision> ring_;
  size_t mask_, latest_ = 0;
};

}  // namespace turbid
