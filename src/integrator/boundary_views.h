#pragma once
#include <compare>
#include <functional>
#include <set>
#include <vector>

#include "integrator/light_balance.h"
#include "path/light_sources.h"
#include "path/path_settings.h"
#include "path/walk.h"

namespace turbid {

/// A side of an object's surface; outer: that of its geometric normal.
struct SurfaceSide {
  const Object* object;
  bool outer;
  auto operator<=>(const SurfaceSide&) const = default;
};

/// The radiance, W/(sr m^2), that someone says a walk from outside sees by the first collision of its visit: what is
/// scattered there towards the walk, times the walk's throughput, over the coefficient of scattering.
using Prediction = std::function<Spectrum(const CollisionEvent& event, const PathState& state, Rng& rng)>;

/// The power, W, that leaves a medium by a prediction, with the places where it is scattered last: its sum is what
/// crosses the medium's boundary in a ball outwards, or comes to opaque surfaces in it; on these sides of surfaces
/// alone (what no light comes to, as the inside of a wall, a prediction may know nothing of).
///
/// Lines at random through the ball cross each surface in it like Lambertian light (Crofton): from where one comes into
/// the medium, or out of an opaque surface in it, a walk looks in that direction. `seed` names the random numbers.
std::vector<LeavingPower> look_into(const Scene& scene, const Medium& medium, const std::set<SurfaceSide>& sides,
                                    const Ball& ball, size_t lines, uint64_t seed, const Prediction& prediction);

}  // namespace turbid
