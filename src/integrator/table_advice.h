#pragma once
#include "scene/scene.h"

namespace turbid {

/// About how many times too bright the reflected light of order 3 and more would be if the medium had no end, in the
/// channel that is farthest off: what a plain table makes of it. By what the boundary of the first object filled with
/// it gives back of broad light, R = (2AD kappa - 1) / (2AD kappa + 1) (see Boundaries), where an endless medium gives
/// back nothing of either sign; 1 / (1 + 0.9 R) fits the layers of docs/tables.md within 6 %. 1 where nothing is known.
float brightness_without_end(const Scene& scene, const Medium& medium);

}  // namespace turbid
