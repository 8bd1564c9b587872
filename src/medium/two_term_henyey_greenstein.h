#pragma once
#include <string>
#include <vector>

#include "medium/blend_phase.h"

namespace turbid {

/// f = w HG(g1) + (1 - w) HG(g2): the weight belongs to the first term.
class TwoTermHenyeyGreensteinPhase final : public BlendPhase {
 public:
  struct Terms {
    float w, g1, g2;
  };
  /// Throws std::invalid_argument unless 0 <= w <= 1 and both g lie between -1 and 1.
  explicit TwoTermHenyeyGreensteinPhase(const Terms& terms);
};

/// The fits under S3 Fig. 9: "ocean_water" to a Fournier-Forand and "water_droplets" to a Mie phase function.
///
/// The figure says "a weight" without saying of which term. Of the first one, it makes ocean water scatter forward with
/// a mean cosine of 0.973 and droplets with 0.579; of the second one, the droplets would scatter backward on the whole
/// (-0.028), which no droplet does. The text's 0.85 for both is met by neither reading.
std::vector<std::string> two_term_presets();
/// Throws std::invalid_argument for any other name.
TwoTermHenyeyGreensteinPhase::Terms two_term_preset(const std::string& name);

}  // namespace turbid
