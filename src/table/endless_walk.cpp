#include "table/endless_walk.h"

#include <bit>

namespace turbid {
namespace {

/// Eight vectors, filled one by one.
struct VectorRows {
  std::array<LaneRow, 3> rows;
  void set(size_t lane, const Vec3& v) {
    rows[0][lane] = v.x;
    rows[1][lane] = v.y;
    rows[2][lane] = v.z;
  }
  Vec3Lanes lanes() const { return {load_lanes(rows[0]), load_lanes(rows[1]), load_lanes(rows[2])}; }
};

}  // namespace

EndlessWalks::EndlessWalks(const PhaseFunction& phase, size_t reach, uint64_t seed)
    : phase_(phase),
      reach_(reach),
      mask_(std::bit_ceil(reach + 1) - 1),
      ring_((mask_ + 1) * kCount),
      direction_(lanes_of({0, 0, 1})) {
  for (size_t w = 0; w < kCount; ++w) {
    rngs_[w] = Rng(hash_counters(seed, w));
    ring_[w] = {{0, 0, 0}, {0, 0, 1}};
  }
  for (size_t i = 0; i < reach; ++i) step();
}

void EndlessWalks::step() {
  const LaneRow flights = to_row(scatter_and_fly(phase_, rngs_, direction_));
  const std::array<LaneRow, 3> directions{to_row(direction_.x), to_row(direction_.y), to_row(direction_.z)};
  for (size_t axis = 0; axis < 3; ++axis)
    for (size_t w = 0; w < kCount; ++w)
      position_[axis][w] += static_cast<double>(directions[axis][w]) * static_cast<double>(flights[w]);
  Collision* const to = ring_.data() + (++latest_ & mask_) * kCount;
  for (size_t w = 0; w < kCount; ++w)
    to[w] = {{position_[0][w], position_[1][w], position_[2][w]},
             {directions[0][w], directions[1][w], directions[2][w]}};
}

EndlessWalks::Passages EndlessWalks::latest(const Flights& flights) const {
  VectorRows ray, axis, displacement, last_direction;
  for (size_t w = 0; w < kCount; ++w) {
    const Collision &before = back(w, flights[w] + 1), &first = back(w, flights[w]), &last = back(w, 0);
    ray.set(w, Vec3(first.position - before.position));
    axis.set(w, first.direction);
    displacement.set(w, Vec3(last.position - first.position));
    last_direction.set(w, last.direction);
  }
  return {ray.lanes(), axis.lanes(), displacement.lanes(), last_direction.lanes()};
}

EndlessWalks::Passages EndlessWalks::joined(const Flights& flights) {
  Passages result{};
  for (size_t walk = 0; walk < kCount; ++walk) {
    VectorRows ray, axis, displacement, last_direction;
    LaneRow azimuth;
    for (size_t lane = 0; lane < kCount; ++lane) {
      // Lengths that differ by one at most and add up.
      const size_t length = flights[lane] * (walk + 1) / kCount - flights[lane] * walk / kCount;
      const auto room = static_cast<uint64_t>(reach_ - length);
      const auto end = static_cast<size_t>(uint64_t{rngs_[walk].next_u32()} * room >> 32);
      const Collision &first = back(walk, end + length), &last = back(walk, end);
      if (walk == 0)
        ray.set(lane, Vec3(first.position - back(walk, end + length + 1).position));
      else
        azimuth[lane] = rngs_[walk].next_float();
      axis.set(lane, first.direction);
      displacement.set(lane, Vec3(last.position - first.position));
      last_direction.set(lane, last.direction);
    }
    if (walk == 0) {
      result = {ray.lanes(), axis.lanes(), displacement.lanes(), last_direction.lanes()};
      continue;
    }
    const FrameLanes from(axis.lanes()), to(result.last_direction);
    const TurnLanes turn(load_lanes(azimuth));
    const auto turned = [&](const Vec3Lanes& v) {
      const Vec3Lanes local = from.to_local(v);
      return to.to_world(
          {turn.cosine * local.x - turn.sine * local.y, turn.sine * local.x + turn.cosine * local.y, local.z});
    };
    result.displacement = result.displacement + turned(displacement.lanes());
    result.last_direction = normalize(turned(last_direction.lanes()));
  }
  return result;
}

}  // namespace turbid
