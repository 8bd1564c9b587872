#pragma once
#include "medium/phase_function.h"
#include "table/photon_lobes.h"

namespace turbid {

/// What light that arrives from somewhere leaves a collision with, in all of LobeDirections: the phase function, the
/// mean of both sides of the sagittal plane. Made once for all steps of arriving directions, each a quarter of those of
/// LobeDirections wide both ways: 1.25 and 2.5 degrees.
class ArrivalLobes {
 public:
  explicit ArrivalLobes(const PhaseFunction& phase);

  /// The step that a direction in the frame of SagittalView is in.
  static uint32_t step(const Vec3& direction);
  /// kCount values of f, 1/sr.
  const float* lobe(uint32_t step) const { return values_.data() + size_t{step} * LobeDirections::kCount; }

 private:
  static constexpr int kPolar = 4 * LobeDirections::kPolar, kAzimuths = 4 * LobeDirections::kAzimuths;
  std::vector<float> values_;  ///< [step][direction]
};

}  // namespace turbid
