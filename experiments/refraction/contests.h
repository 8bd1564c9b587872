#pragma once
#include <cstdint>
#include <string>

namespace turbid::experiments {

struct ContestSettings {
  std::string scenes = "scenes";  ///< folder of the scenes that ship
  std::string images;             ///< folder for pictures; empty: none
  int size = 40;                  ///< pixels along the shorter side
  uint32_t samples = 4;           ///< of triangle intervals, per pixel
  uint32_t reference_samples = 96;
};

/// S4 Fig. 1 (the bumpy ball) and Fig. 6 (there a rabbit, here the statue): light of order 1 by every method in the
/// time of triangle intervals, as a table of errors.
void print_equal_time(const ContestSettings& settings, bool statue);

/// S4 Fig. 8: how long the others take for the error of triangle intervals; at least `factor` times as long is allowed.
void print_equal_quality(const ContestSettings& settings, double factor);

}  // namespace turbid::experiments
