#include "table/endless_walk.h"

#include <bit>

#include "core/frame.h"

namespace turbid {

EndlessWalk::EndlessWalk(const PhaseFunction& phase, size_t reach, uint64_t seed)
    : phase_(phase), rng_(seed), reach_(reach), ring_(std::bit_ceil(reach + 1)), mask_(ring_.size() - 1) {
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

EndlessWalk::Passage EndlessWalk::passage(size_t end, size_t flights) const {
  const Collision &before = back(end + flights + 1), &first = back(end + flights), &last = back(end);
  return {Vec3(first.position - before.position), first.direction, Vec3(last.position - first.position),
          last.direction};
}

EndlessWalk::Passage EndlessWalk::any(size_t flights) {
  const auto room = static_cast<uint64_t>(reach_ - flights);
  return passage(static_cast<size_t>(uint64_t{rng_.next_u32()} * room >> 32), flights);
}

EndlessWalk::Passage join_passages(std::span<EndlessWalk> walks, size_t flights) {
  EndlessWalk::Passage result{};
  for (size_t i = 0; i < walks.size(); ++i) {
    // Lengths that differ by one at most and add up.
    const size_t length = flights * (i + 1) / walks.size() - flights * i / walks.size();
    const EndlessWalk::Passage piece = walks[i].any(length);
    if (i == 0) {
      result = piece;
      continue;
    }
    const float phi = 2 * kPi * walks[i].rng().next_float(), c = std::cos(phi), s = std::sin(phi);
    const Frame from(piece.axis), plain(result.last_direction);
    const Frame to(plain.s * c + plain.t * s, plain.t * c - plain.s * s, plain.n);
    result.displacement += to.to_world(from.to_local(piece.displacement));
    result.last_direction = normalize(to.to_world(from.to_local(piece.last_direction)));
  }
  return result;
}

}  // namespace turbid
