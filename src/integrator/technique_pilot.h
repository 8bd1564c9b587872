#pragma once
#include <span>

#include "integrator/upbp.h"

namespace turbid {

/// The last of growing sets of techniques whose variance times work is little above the least; the first where none is
/// finite. `products` in the order of the sets, not empty.
size_t fullest_affordable(std::span<const double> products);

/// Tries growing sets of techniques on a few pixels of a few small images, and chooses the fullest whose variance times
/// counted work is little above the least, and the number of light paths that leave beams. Weights do not know what
/// techniques cost: B-B1D can take nearly all time of an image and gain little. Depends on scene, settings and seed
/// alone.
UpbpSettings choose_techniques(const Scene& scene, const PathSettings& path, const UpbpSettings& own, uint64_t seed,
                               const StopFlag& stop);

}  // namespace turbid
