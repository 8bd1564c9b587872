#pragma once
#include "core/vector.h"
#include "medium/phase_function.h"

namespace turbid {

/// Scattering by particles much smaller than the wavelength, unpolarised: f(mu) = 3 (1 + mu^2) / (16 pi).
class RayleighPhase final : public PhaseFunction {
 public:
  float eval(float mu) const override { return (3 * kInvPi / 16) * (1 + mu * mu); }

  /// Inverts the CDF (4 + 3 mu + mu^3) / 8 = u by Cardano's formula for mu^3 + 3 mu = 2 q, q = 4 u - 2.
  float sample(float u) const override {
    const float q = 4 * u - 2, magnitude = std::abs(q);
    const float root = std::cbrt(magnitude + std::sqrt(q * q + 1));
    return std::copysign(std::min(root - 1 / root, 1.0f), q);
  }

  float mean_cosine() const override { return 0; }
};

}  // namespace turbid
