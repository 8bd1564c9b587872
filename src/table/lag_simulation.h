#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "table/light_field.h"
#include "table/phase_moments.h"
#include "table/polar_grid.h"
#include "table/sagittal_harmonics.h"

namespace turbid {

/// What the tables are made of: cells and bands.
struct TableShape {
  PolarGrid grid{48, 28, 250};
  BandLimits bands;
  /// Numbers that a cell holds: rows of SagittalHarmonics::kOrders, one per degree.
  size_t cell_size() const { return (static_cast<size_t>(bands.degree) + 1) * SagittalHarmonics::kOrders; }
};

/// Light that collided first ... last times, per source kind and cell: sums over the walk's samples, per source photon
/// and order, before anything is absorbed and before the last collision deflects it.
struct OrderBin {
  int first = 0, last = 0;                                  ///< numbers of collisions
  std::array<std::vector<float>, kSourceKinds> moments;     ///< int Y_lm dV, [cell][l][m]; 1/sr^(1/2)
  std::array<std::vector<float>, kSourceKinds> mean_order;  ///< of what lies in a cell; the last one: beyond the grid
  int count() const { return last - first + 1; }
};

struct SimulationSettings {
  uint64_t seed = 1;
  size_t deposits =
      4'000'000;  ///< per bin and source kind; orders to 6 get twice that, above 128 half, above 1024 a quarter
};

/// Bins of orders of scattering: 3 ... 10 alone, then two per octave up to 22,527.
std::vector<std::pair<int, int>> order_bins();

/// Simulates every bin by an endless walk of its own. At each step a random order of the bin is drawn, and the pair of
/// collisions that far apart is put into the cell of their distance: with the first one as a collision (kCollision),
/// and with the ray that led into it (kRay). Depends on the seed alone, not on the number of threads.
std::vector<OrderBin> simulate_orders(const PhaseFunction& phase, const TableShape& shape,
                                      const SimulationSettings& settings);

}  // namespace turbid
