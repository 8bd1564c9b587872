#include "medium/homogeneous.h"

#include <stdexcept>

namespace turbid {

HomogeneousMedium::HomogeneousMedium(const Spectrum& sigma_t, const Spectrum& sigma_s,
                                     std::shared_ptr<const PhaseFunction> phase)
    : Medium(std::move(phase)),
      sigma_t_(sigma_t),
      sigma_s_(sigma_s),
      grey_(sigma_t.min() == sigma_t.max()),
      scatters_(sigma_s.max() > 0) {
  if (!sigma_t.is_finite() || !sigma_s.is_finite() || sigma_t.min() < 0 || sigma_s.min() < 0)
    throw std::invalid_argument("the coefficients of a medium must be finite and not negative");
  for (int c = 0; c < kChannels; ++c) {
    if (sigma_s[c] > sigma_t[c]) throw std::invalid_argument("a medium cannot scatter more than it extinguishes");
    albedo_[c] = sigma_t[c] > 0 ? sigma_s[c] / sigma_t[c] : 0;
    mean_free_path_[c] = 1 / sigma_t[c];
  }
}

}  // namespace turbid
