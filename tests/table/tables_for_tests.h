#pragma once
#include "core/rng.h"
#include "core/warp.h"
#include "table/scattering_table.h"

namespace turbid::testing {

/// The table of Henyey-Greenstein with this g in the standard grid, of 200,000 samples per bin; made once per program.
const ScatteringTable& small_table(float g);
/// The same with as many samples as users get. Takes ten seconds and more.
ScatteringTable standard_table(float g);

}  // namespace turbid::testing
