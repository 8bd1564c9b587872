#include "texture/blackbody.h"

#include <array>
#include <stdexcept>

namespace turbid {
namespace {

/// A bell with different widths to its two sides.
double lobe(double wavelength, double peak, double inverse_left, double inverse_right) {
  const double t = (wavelength - peak) * (wavelength < peak ? inverse_left : inverse_right);
  return std::exp(-0.5 * t * t);
}

/// CIE 1931 colour matching functions at a wavelength in nm: the multi-lobe fit of Wyman et al. 2013.
std::array<double, 3> observer(double w) {
  return {0.362 * lobe(w, 442.0, 0.0624, 0.0374) + 1.056 * lobe(w, 599.8, 0.0264, 0.0323) -
              0.065 * lobe(w, 501.1, 0.0490, 0.0382),
          0.821 * lobe(w, 568.8, 0.0213, 0.0247) + 0.286 * lobe(w, 530.9, 0.0613, 0.0322),
          1.217 * lobe(w, 437.0, 0.0845, 0.0278) + 0.681 * lobe(w, 459.0, 0.0385, 0.0725)};
}

/// Planck's law, W/(sr m^2 nm), wavelength in nm.
double planck(double w, double kelvin) {
  constexpr double kC1 = 1.191042972e-16, kC2 = 1.438776877e-2;  // 2 h c^2 and h c / k (CODATA)
  const double metres = w * 1e-9;
  return 1e-9 * kC1 / (metres * metres * metres * metres * metres * std::expm1(kC2 / (metres * kelvin)));
}

constexpr int kSteps = 95;
constexpr double kFirst = 360, kStep = 5;

/// Linear Rec. 709 of light of one wavelength, per nm, at the middle of each step; luminance sums to 1.
const std::array<std::array<double, 3>, kSteps>& responses() {
  static const auto table = [] {
    std::array<std::array<double, 3>, kSteps> rgb{};
    double luminance = 0;
    for (int i = 0; i < kSteps; ++i) luminance += observer(kFirst + i * kStep)[1];
    for (int i = 0; i < kSteps; ++i) {
      const auto [x, y, z] = observer(kFirst + i * kStep);
      rgb[static_cast<size_t>(i)] = {(3.240479 * x - 1.537150 * y - 0.498535 * z) / luminance,
                                     (-0.969256 * x + 1.875991 * y + 0.041556 * z) / luminance,
                                     (0.055648 * x - 0.204043 * y + 1.057311 * z) / luminance};
    }
    return rgb;
  }();
  return table;
}

}  // namespace

Spectrum blackbody(float temperature) {
  if (!(temperature > 0)) return Spectrum(0.0f);
  std::array<double, 3> sum{};
  for (int i = 0; i < kSteps; ++i) {
    const double radiance = planck(kFirst + i * kStep, double(temperature));
    for (size_t c = 0; c < 3; ++c) sum[c] += radiance * responses()[static_cast<size_t>(i)][c];
  }
  const auto clamped = [](double v) { return static_cast<float>(std::max(v, 0.0)); };
  return {clamped(sum[0]), clamped(sum[1]), clamped(sum[2])};
}

BlackbodyVolume::BlackbodyVolume(std::shared_ptr<const Volume> temperature, float scale)
    : temperature_(std::move(temperature)) {
  if (!(scale >= 0) || !std::isfinite(scale))
    throw std::invalid_argument("the scale of black body radiation must be finite and not negative");
  constexpr size_t kEntries = 4096;
  const float highest = std::max(temperature_->range(temperature_->bounds()).max[0], 1.0f);
  step_ = highest / (kEntries - 1);
  table_.resize(kEntries);
  for (size_t i = 0; i < kEntries; ++i) table_[i] = blackbody(step_ * static_cast<float>(i)) * scale;
}

Spectrum BlackbodyVolume::radiance(float temperature) const {
  const float at = std::clamp(temperature / step_, 0.0f, static_cast<float>(table_.size() - 1));
  const size_t i = std::min(static_cast<size_t>(at), table_.size() - 2);
  return lerp(table_[i], table_[i + 1], at - static_cast<float>(i));
}

}  // namespace turbid
