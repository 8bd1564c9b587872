#pragma once
#include <span>
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

  /// What lies between two collisions.
  struct Passage {
    Vec3 ray;             ///< of the flight into the first one; its direction is `axis`
    Vec3 axis;            ///< unit, into the first collision
    Vec3 displacement;    ///< from the first to the last
    Vec3 last_direction;  ///< unit, into the last one
  };
  /// From the collision `flights` before the latest to the latest.
  Passage latest(size_t flights) const { return passage(0, flights); }
  /// The same for any collision that is remembered, by a random number of the walk's; flights < reach.
  Passage any(size_t flights);

 private:
  Passage passage(size_t end, size_t flights) const;

  const PhaseFunction& phase_;
  Rng rng_;
  size_t reach_;
  std::vector<Collision> ring_;
  size_t mask_, latest_ = 0;
};

/// A passage of `flights` flights joined from one piece of each of these walks, turned at random about the direction in
/// which it takes up. A walk has no memory but its direction, so this too is a sample; but pairs of one walk that are
/// far apart change slowly from step to step, and joined ones do not. The walks must be independent.
EndlessWalk::Passage join_passages(std::span<EndlessWalk> walks, size_t flights);

}  // namespace turbid
