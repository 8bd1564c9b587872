#pragma once
#include "medium/blend_phase.h"

namespace turbid {

/// Scattering by water droplets of a given diameter, as a blend of a Henyey-Greenstein peak and a Draine lobe whose
/// parameters follow the diameter (Jendersie & d'Eon 2023, with the ranges below 5 um from their supplemental). Meant
/// for fog and clouds, 5 to 50 um; it has neither rainbow nor glory, for which there is MiePhase.
class MieFitPhase final : public BlendPhase {
 public:
  struct Parameters {
    float g_hg;      ///< of the peak
    float g_draine;  ///< of the lobe
    float alpha;     ///< of the lobe
    float w_draine;  ///< weight of the lobe; the peak has 1 - w
  };
  /// For a diameter in micrometres. Throws std::invalid_argument unless it lies in (0, 50].
  static Parameters parameters(float diameter);

  explicit MieFitPhase(float diameter) : MieFitPhase(parameters(diameter)) {}

 private:
  explicit MieFitPhase(const Parameters& p);
};

}  // namespace turbid
