#include "table/tables_for_tests.h"

#include <map>

#include "medium/henyey_greenstein.h"
#include "table/table_cache.h"

namespace turbid::testing {

namespace {

ScatteringTable build(float g, size_t samples) {
  const HenyeyGreensteinPhase phase(g);
  TableShape shape;
  shape.bands = choose_bands(phase);
  return build_table(phase, shape, {1, samples > 0 ? samples : default_deposits(shape.bands)});
}

}  // namespace

ScatteringTable standard_table(float g) { return build(g, 0); }

const ScatteringTable& small_table(float g) {
  static std::map<float, ScatteringTable> tables;
  const auto found = tables.find(g);
  if (found != tables.end()) return found->second;
  return tables.emplace(g, build(g, 200'000)).first->second;
}

}  // namespace turbid::testing
