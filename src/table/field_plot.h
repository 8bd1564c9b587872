#pragma once
#include "image/image.h"
#include "table/lobe_field.h"

namespace turbid {

/// A picture of a light field in a plane through the source's axis, which points to the right; `reach` mean free paths
/// to each side. The logarithm of the density, six decades from black over red to white, and over it lobes: at a
/// lattice of places how much light leaves towards each direction, the largest as long as half of the lattice's step.
Image plot_field(const LobeField& field, double reach, int size = 640);

}  // namespace turbid
