#include "table/flights.h"

namespace turbid {

Lanes scatter_and_fly(const PhaseFunction& phase, std::array<Rng, kLanes>& rngs, Vec3Lanes& direction) {
  LaneRow mu, azimuth, whole, rest;
  for (size_t lane = 0; lane < kLanes; ++lane) {
    Rng& rng = rngs[lane];
    mu[lane] = phase.sample(rng.next_float());
    azimuth[lane] = rng.next_float();
    // 1 - u has 24 bits. Flights of more than 12 ln 2 mean free paths are drawn anew from there, so none is too long.
    float flight = 0, u = rng.next_float();
    while (u >= 1 - 0x1p-12f) {
      flight += 12 * std::numbers::ln2_v<float>;
      u = rng.next_float();
    }
    whole[lane] = flight;
    rest[lane] = 1 - u;
  }
  const Lanes cosine = load_lanes(mu), sine = safe_sqrt(1 - cosine * cosine);
  const TurnLanes turn(load_lanes(azimuth));
  direction = normalize(FrameLanes(direction).to_world({sine * turn.cosine, sine * turn.sine, cosine}));
  return load_lanes(whole) - log_lanes(load_lanes(rest));
}

}  // namespace turbid
