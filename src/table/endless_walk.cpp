#include "table/endless_walk.h"

#include <bit>

#include "core/frame.h"

namespace turbid {

EndlessWalk::EndlessWalk(const PhaseFunction& phase, size_t reach, uint64_t seed)
    : phase_(phase), rng_(seed), ring_(std::bit_ceil(reach + 1)), mask_(ring_.size() - 1) {
  ring_[0] = {{0, 0, 0}, {0, 0, 1}};
  for (size_t i = 0; i < reach; ++i) step();
}

void EndlessWalk::step() {
  const Collision& from = ring_[latest_ & mask_];
  const float mu = phase_.sample(rng_.next_float());
  const Vec3 direction = normalize(direction_about(from.direction, mu, 2 * kPi * rng_.next_float()));
  // 1 - u has 24 bits. Flights of more than 12 ln 2 mean free paths are drawn anew from there, so none is too long.
  float flight = 0, u = rng_.next_float();
  while (u >= 1 - 0x1p-12f) {
    flight += 12 * std::numbers::ln2_v<float>;
    u = rng_.next_float();
  }
  flight -= std::log(1 - u);
  const Imath::V3d position = from.position + Imath::V3d(direction) * static_cast<double>(flight);
  ring_[++latest_ & mask_] = {position, direction};
}

}  // namespace turbid
