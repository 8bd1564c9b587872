#pragma once
#include "core/rng.h"
#include "medium/homogeneous.h"
#include "table/multiple_scattering.h"

namespace turbid {

/// What MultipleScattering looks up, estimated by one random walk in a medium without end: the reference that tells
/// what the table adds from what the model, a medium without end, adds.
///
/// The walk begins on the light's stretch; at each of its collisions the last but one collision of a path is inserted
/// between it and x (once more, NUMERICS 2): c_1 ... c_j, inserted, x is an order of j + 2. So no line between two
/// collisions is of given ends, and the variance is finite.
///
/// The source radiance at x towards w of the orders from `from_order` on, per unit of flux that sets out along `light`.
Spectrum walk_source_radiance(const HomogeneousMedium& medium, int from_order, const Stretch& light, const Vec3& x,
                              const Vec3& w, Rng& rng);

}  // namespace turbid
