#pragma once
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "table/lag_simulation.h"

namespace turbid {

/// The largest albedo of a table: with more, light goes on for tens of thousands of collisions.
inline constexpr double kLargestAlbedo = 0.9995;
/// Albedos are interpolated over (1 - albedo)^(1/4), in which the tables' values are smooth.
inline constexpr int kAlbedoNodes = 12;
double albedo_at_node(int node);

/// Multiple scattering of one phase function in an infinite medium, for every albedo up to kLargestAlbedo; mean free
/// path 1 (NUMERICS 8, mode "exact").
///
/// Three sets of cells for each source kind: light that collided three times and four times, as it is without
/// absorption, and at each node of albedo sum_{n>=5} albedo^(n-5) T_n. A cell holds r T_00 as a float and the ratios
/// T_lm / T_00 in 8 bits, relative to each (l, m)'s largest and finer towards 0: where light has become smooth all of
/// them are small. The last deflection is in them (band l times f_l), albedo^3, ^4 and ^5 are not.
struct ScatteringTable {
  static constexpr size_t kSets = kAlbedoNodes + 2;
  static constexpr size_t kOrder3 = kAlbedoNodes, kOrder4 = kAlbedoNodes + 1;

  struct Kind {
    std::vector<float> density;  ///< [set][cell] r T_00, sqrt(4 pi) times less than r times the fluence's source
    std::vector<float> largest;  ///< [coefficient] ratio in the table
    std::vector<int8_t> ratios;  ///< [set][cell][coefficient]
  };

  TableShape shape;
  std::vector<double> moments;  ///< f_l of the phase function, l = 0 ... 64
  uint64_t seed = 0;
  uint64_t deposits = 0;  ///< samples per bin of orders
  std::array<Kind, kSourceKinds> kinds;

  /// (l, m) of each stored coefficient, without (0, 0).
  std::vector<std::pair<int, int>> coefficients() const;
  /// Memory in bytes.
  size_t size() const;
};

/// A ratio in 8 bits: its sign and the root of its size over the largest one's, in steps of 1/127.
inline int8_t encode_ratio(float ratio, float largest) {
  if (!(largest > 0)) return 0;
  return static_cast<int8_t>(std::lround(std::copysign(127 * std::sqrt(std::abs(ratio) / largest), ratio)));
}
inline float decode_ratio(int8_t code, float largest) {
  const float root = static_cast<float>(code) / 127;
  return root * std::abs(root) * largest;
}

/// Simulates and packs. Seconds of time.
ScatteringTable build_table(const PhaseFunction& phase, const TableShape& shape, const SimulationSettings& settings);

}  // namespace turbid
