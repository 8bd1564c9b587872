#include "table/tables_for_tests.h"

#include <map>

#include "medium/henyey_greenstein.h"

namespace turbid::testing {

const ScatteringTable& small_table(float g) {
  static std::map<float, ScatteringTable> tables;
  const auto found = tables.find(g);
  if (found != tables.end()) return found->second;
  const HenyeyGreensteinPhase phase(g);
  TableShape shape;
  shape.bands = choose_bands(phase);
  return tables.emplace(g, build_table(phase, shape, {1, 200'000})).first->second;
}

}  // namespace turbid::testing
