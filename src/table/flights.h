#pragma once
#include "core/rng.h"
#include "medium/phase_function.h"
#include "table/lanes.h"

namespace turbid {

/// Eight photons that collide in a medium with mean free path 1: each is scattered, its direction becomes the new one,
/// and flies on. Returns how far; of the order of one, never above some hundred. About three words of each random
/// stream.
Lanes scatter_and_fly(const PhaseFunction& phase, std::array<Rng, kLanes>& rngs, Vec3Lanes& direction);

}  // namespace turbid
