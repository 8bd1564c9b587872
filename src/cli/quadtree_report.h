#pragma once
#include <string>

#include "medium/phase_function.h"
#include "table/table_cache.h"

namespace turbid {

/// What `turbid table --mode seed` is asked for beside the material.
struct QuadtreeReport {
  QuadtreeSettings settings;
  TableRequest exact;  ///< the table of mode `exact` that it is compared with; its folder serves both
  std::string prefix;  ///< of plots' names; empty: none
  double reach = 8;    ///< of plots to each side, mean free paths
};

/// Finds or builds a material's table and prints its memory, time and cells, and for each source and albedo its energy
/// and how far it is from the exact one.
void print_quadtree(const PhaseFunction& phase, const Spectrum& albedo, const QuadtreeReport& report);

}  // namespace turbid
