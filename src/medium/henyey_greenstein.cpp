#include "medium/henyey_greenstein.h"

#include <cmath>
#include <stdexcept>
#include <string>

namespace turbid {

HenyeyGreensteinPhase::HenyeyGreensteinPhase(float g) : g_(g), sign_(std::copysign(1.0f, g)), two_a_(2 * std::abs(g)) {
  if (!(std::abs(g) < 1))
    throw std::invalid_argument("the mean cosine g of a Henyey-Greenstein phase function must lie between -1 and 1, " +
                                std::to_string(g) + " does not");
  const double a = std::abs(static_cast<double>(g));
  one_minus_a_ = static_cast<float>(1 - a);
  numerator_ = static_cast<float>((1 - a) * (1 + a) / (4 * std::numbers::pi));
}

}  // namespace turbid
