#include "medium/two_term_henyey_greenstein.h"

#include <map>
#include <stdexcept>

#include "medium/henyey_greenstein.h"

namespace turbid {
namespace {

const std::map<std::string, TwoTermHenyeyGreensteinPhase::Terms>& presets() {
  static const std::map<std::string, TwoTermHenyeyGreensteinPhase::Terms> table{
      {"ocean_water", {.w = 0.339242f, .g1 = 0.997229f, .g2 = 0.959952f}},
      {"water_droplets", {.w = 0.712146f, .g1 = 0.990344f, .g2 = -0.439579f}}};
  return table;
}

}  // namespace

TwoTermHenyeyGreensteinPhase::TwoTermHenyeyGreensteinPhase(const Terms& terms)
    : BlendPhase(std::make_shared<HenyeyGreensteinPhase>(terms.g1), std::make_shared<HenyeyGreensteinPhase>(terms.g2),
                 1 - terms.w) {}

std::vector<std::string> two_term_presets() {
  std::vector<std::string> names;
  for (const auto& [name, terms] : presets()) names.push_back(name);
  return names;
}

TwoTermHenyeyGreensteinPhase::Terms two_term_preset(const std::string& name) {
  const auto found = presets().find(name);
  if (found == presets().end()) throw std::invalid_argument("there is no two-term preset '" + name + "'");
  return found->second;
}

}  // namespace turbid
