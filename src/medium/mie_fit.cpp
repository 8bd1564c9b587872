#include "medium/mie_fit.h"

#include <cmath>
#include <stdexcept>
#include <string>

#include "medium/draine.h"

namespace turbid {
namespace {

// The four ranges of the fit; d is the diameter in micrometres, l its logarithm.

MieFitPhase::Parameters large(double d) {
  return {.g_hg = static_cast<float>(std::exp(-0.0990567 / (d - 1.67154))),
          .g_draine = static_cast<float>(std::exp(-2.20679 / (d + 3.91029) - 0.428934)),
          .alpha = static_cast<float>(std::exp(3.62489 - 8.29288 / (d + 5.52825))),
          .w_draine = static_cast<float>(std::exp(-0.599085 / (d - 0.641583) - 0.665888))};
}

MieFitPhase::Parameters middle(double l) {
  const double ll = std::log(l);
  return {.g_hg = static_cast<float>(0.940256 + 0.0604931 * ll),
          .g_draine = static_cast<float>(0.500411 - 0.081287 / (std::tan(l) - 2 * l + 1.27551)),
          .alpha = static_cast<float>(6.31675 + 7.30354 * l),
          .w_draine = static_cast<float>(0.376475 + 0.026914 * (l - std::cos(5.68947 * (ll - 0.0292149))))};
}

MieFitPhase::Parameters small(double l) {
  const double inner = std::cos((l - 0.238604) * (l + 1.00667) / (0.507522 - 0.15677 * l));
  return {.g_hg = static_cast<float>(0.862 - 0.143 * l * l),
          .g_draine = static_cast<float>(0.344213 + 0.379685 * std::cos(1.19692 * inner + 1.37932 * l + 0.0625835)),
          .alpha = 250,
          .w_draine = static_cast<float>(0.316072 + 0.0778917 * l + 0.146209 * std::cos(3.38707 * l + 2.11193))};
}

MieFitPhase::Parameters tiny(double d) {
  return {.g_hg = static_cast<float>(13.8 * d * d),
          .g_draine = static_cast<float>(1.1456 * d * std::sin(9.29044 * d)),
          .alpha = 250,
          .w_draine = static_cast<float>(0.252977 - 312.983 * std::pow(d, 4.3))};
}

}  // namespace

MieFitPhase::Parameters MieFitPhase::parameters(float diameter) {
  if (!(diameter > 0 && diameter <= 50))
    throw std::invalid_argument("the fit to Mie scattering holds for diameters up to 50 micrometres, not for " +
                                std::to_string(diameter));
  const auto d = static_cast<double>(diameter);
  if (d <= 0.1) return tiny(d);
  if (d < 1.5) return small(std::log(d));
  if (d < 5) return middle(std::log(d));
  return large(d);
}

MieFitPhase::MieFitPhase(const Parameters& p)
    : BlendPhase(std::make_shared<HenyeyGreensteinPhase>(p.g_hg), std::make_shared<DrainePhase>(p.g_draine, p.alpha),
                 p.w_draine) {}

}  // namespace turbid
