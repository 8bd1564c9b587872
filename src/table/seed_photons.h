#pragma once
#include <algorithm>

#include "core/spectrum.h"
#include "table/flights.h"
#include "table/photon_lobes.h"

namespace turbid {

/// Photons that collide at the origin, having travelled along +z. Each goes on by chance, with the largest channel's
/// albedo and, from the 32nd collision on, so that their number also falls like the root of the order, and has a random
/// stream of its own. At high albedo most of the time would go into late collisions, hundreds of each photon, which
/// tell little that their neighbours do not.
class SeedPhotons {
 public:
  /// One collision of a photon.
  struct Collision {
    Vec3 position, direction;  ///< of the flight that ended there
    int order;
  };

  SeedPhotons(const PhaseFunction& phase, const Spectrum& albedo, const QuadtreeSettings& settings)
      : phase_(phase), largest_(albedo.max()), settings_(settings) {
    for (int c = 0; c < kChannels; ++c) {
      first_flux_[c] = std::pow(albedo[c], static_cast<float>(settings.from_order));
      decay_[c] = albedo[c] > 0 ? std::log2(albedo[c] / largest_) : 0;
    }
  }

  /// How many of the photons that are not absorbed go on to a collision of this order.
  static float left(int order) { return std::min(1.0f, std::sqrt(32 / static_cast<float>(order))); }
  /// left(order + 1) / left(order).
  static float goes_on(int order) { return order < 32 ? 1 : std::sqrt(1 - 1 / static_cast<float>(order + 1)); }

  /// What leaves a collision of this order, per photon.
  Spectrum flux(int order) const {
    const auto later = static_cast<float>(order - settings_.from_order);
    Spectrum result = first_flux_;
    for (int c = 0; c < kChannels; ++c) result[c] *= std::exp2(decay_[c] * later);
    return result / left(order);
  }

  /// Calls visit(collision, rng) for all collisions that count, of the photons first ... last - 1, eight at a time:
  /// when one ends the next begins.
  template <class Visit>
  void follow(uint64_t first, uint64_t last, const Visit& visit) const {
    std::array<Rng, kLanes> rngs;
    std::array<int, kLanes> orders{};  // of the collision where it is; 0: there is no photon any more
    std::array<LaneRow, 3> positions{}, directions;
    size_t flying = 0;
    const auto begin = [&](size_t lane) {
      const bool more = first < last;
      if (more) rngs[lane] = Rng(hash_counters(settings_.seed, first++));
      orders[lane] = more ? 1 : 0;
      flying += more ? 1 : 0;
      for (size_t axis = 0; axis < 3; ++axis) {
        positions[axis][lane] = 0;
        directions[axis][lane] = axis == 2 ? 1 : 0;
      }
    };
    for (size_t lane = 0; lane < kLanes; ++lane) begin(lane);
    while (flying > 0) {
      for (size_t lane = 0; lane < kLanes; ++lane) {
        if (orders[lane] >= settings_.from_order) {
          const auto vector = [&](const std::array<LaneRow, 3>& rows) {
            return Vec3(rows[0][lane], rows[1][lane], rows[2][lane]);
          };
          visit(Collision{vector(positions), vector(directions), orders[lane]}, rngs[lane]);
          // The first collisions are sure.
          if (!(rngs[lane].next_float() < largest_ * goes_on(orders[lane]))) {
            --flying;
            begin(lane);
          }
        }
        if (orders[lane] > 0) ++orders[lane];
      }
      Vec3Lanes direction{load_lanes(directions[0]), load_lanes(directions[1]), load_lanes(directions[2])};
      const Lanes flight = scatter_and_fly(phase_, rngs, direction);
      positions = {to_row(load_lanes(positions[0]) + direction.x * flight),
                   to_row(load_lanes(positions[1]) + direction.y * flight),
                   to_row(load_lanes(positions[2]) + direction.z * flight)};
      directions = {to_row(direction.x), to_row(direction.y), to_row(direction.z)};
    }
  }

 private:
  const PhaseFunction& phase_;
  Spectrum first_flux_;  ///< of the first order that counts
  Spectrum decay_;       ///< log2 of a channel's albedo over the largest one
  float largest_;
  QuadtreeSettings settings_;
};

}  // namespace turbid
