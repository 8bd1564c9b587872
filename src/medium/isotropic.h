#pragma once
#include "core/vector.h"
#include "medium/phase_function.h"

namespace turbid {

/// f(mu) = 1 / (4 pi): every direction alike.
class IsotropicPhase final : public PhaseFunction {
 public:
  float eval(float) const override { return kInvPi / 4; }
  float sample(float u) const override { return 2 * u - 1; }
  float mean_cosine() const override { return 0; }
};

}  // namespace turbid
