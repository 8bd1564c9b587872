#pragma once
#include <span>
#include <vector>

#include "table/flights.h"

namespace turbid {

/// Random walks without end in an infinite, homogeneous medium that absorbs nothing; mean free path 1. The medium looks
/// the same from everywhere, so every pair of a walk's collisions (i, i + k) is a sample of k flights after a collision
/// that was reached along the direction into i. Keeps the last collisions only. Eight independent walks side by side:
/// each waits for its own last step alone, and lanes share the work.
class EndlessWalks {
 public:
  static constexpr size_t kCount = kLanes;
  struct Collision {
    Imath::V3d position;
    Vec3 direction;  ///< of the flight that ended here
  };

  /// Keeps `reach` collisions of each walk before the latest. Walk i draws from the stream (seed, i).
  EndlessWalks(const PhaseFunction& phase, size_t reach, uint64_t seed);

  /// One scattering and one flight of each walk; about three words of each random stream.
  void step();
  /// The collision of a walk `lag` before its latest, lag <= reach.
  const Collision& back(size_t walk, size_t lag) const { return ring_[((latest_ - lag) & mask_) * kCount + walk]; }
  Rng& rng(size_t walk) { return rngs_[walk]; }

  /// What lies between two collisions, eight times.
  struct Passages {
    Vec3Lanes ray;             ///< of the flight into the first one; its direction is `axis`
    Vec3Lanes axis;            ///< unit, into the first collision
    Vec3Lanes displacement;    ///< from the first to the last
    Vec3Lanes last_direction;  ///< unit, into the last one
  };
  /// So many flights, each below the reach.
  using Flights = std::array<size_t, kCount>;
  /// Of each walk, from the collision that many flights before the latest to the latest.
  Passages latest(const Flights& flights) const;
  /// Each joined from one piece of each of the walks, drawn from all that is remembered and turned at random about the
  /// direction in which it takes up; takes up to kCount times as many flights as are remembered. A walk has no memory
  /// but its direction, so this too is a sample; but pairs of one walk that are far apart change slowly from step to
  /// step, and joined ones do not.
  Passages joined(const Flights& flights);

 private:
  const PhaseFunction& phase_;
  std::array<Rng, kCount> rngs_;
  size_t reach_, mask_, latest_ = 0;
  std::vector<Collision> ring_;  ///< [collision][walk]
  Vec3Lanes direction_;          ///< of the latest flights
  std::array<std::array<double, kCount>, 3> position_{};
};

}  // namespace turbid
