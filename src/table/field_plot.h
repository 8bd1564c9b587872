#pragma once
#include "image/image.h"
#include "table/quadtree_table.h"

namespace turbid {

/// Pictures of a light field in a plane through the source's axis, which points to the right; `reach` mean free paths
/// to each side. The logarithm of the density, six decades from black over red to white, and something over it.

/// Lobes: at a lattice of places how much light leaves towards each direction, the largest as long as half of the
/// lattice's step; blue. Those of another field over them in green, at the same scale (S1 Fig. 7, 14).
Image plot_field(const LightField& field, double reach, int size = 640, const LightField* other = nullptr);

/// Lines along the optimal axes of a quadtree's lobes (S1 Fig. 4).
Image plot_axes(const QuadtreeField& field, double reach, int size = 640);

/// The cells of a quadtree, whole (S1 Fig. 13): the source's axis at the bottom, from half the reach behind the source.
Image plot_cells(const QuadtreeField& field, int width = 960);

}  // namespace turbid
