#pragma once
#include <memory>
#include <string>

#include "table/quadtree_table.h"
#include "table/scattering_table.h"

namespace turbid {

/// What a table is built with, and where it is kept.
struct TableRequest {
  SimulationSettings settings;  ///< deposits 0: as many as fit the phase function (default_deposits)
  /// Empty: $TURBID_TABLES, else $XDG_CACHE_HOME/turbid/tables, else ~/.cache/turbid/tables.
  std::string folder;
};

/// Samples per bin that the bands of a phase function ask for: more bands are noisier.
size_t default_deposits(const BandLimits& bands);

/// The folder and the file of a table: its name is made of all that it depends on (moments, shape, samples, seed).
std::string table_path(const PhaseFunction& phase, const TableRequest& request);

/// The table of a phase function: from the cache, or built and put there. A damaged or foreign file there is replaced
/// with a warning; a folder that cannot be written to costs a warning and the time to build. Two processes that build
/// the same table at once both succeed, the second replaces the file by its equal. Tables in use are shared within a
/// process. Throws std::invalid_argument with advice for phase functions that tables do not hold (choose_bands).
std::shared_ptr<const ScatteringTable> find_table(const PhaseFunction& phase, const TableRequest& request = {});

/// The same of mode `seed`: one for each phase function and albedo, of any phase function. `folder` as above. Throws
/// std::invalid_argument with advice for albedos above kLargestAlbedo.
std::string quadtree_path(const PhaseFunction& phase, const Spectrum& albedo, const QuadtreeSettings& settings,
                          const std::string& folder = "");
std::shared_ptr<const QuadtreeTable> find_quadtree(const PhaseFunction& phase, const Spectrum& albedo,
                                                   const QuadtreeSettings& settings = {},
                                                   const std::string& folder = "");

}  // namespace turbid
