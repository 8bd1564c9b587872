#pragma once
#include <memory>
#include <vector>

#include "texture/volume.h"

namespace turbid {

/// Radiance of a black body in linear Rec. 709, by Planck's law and the CIE 1931 observer in the form of Wyman et al.
/// 2013, scaled so that a spectrum of 1 W/(sr m^2 nm) at every wavelength has luminance 1. Kelvin; at and below 0 it is
/// 0. Colours beyond the gamut (below about 1900 K, blue) are clamped to it.
Spectrum blackbody(float temperature);

/// What matter of a given temperature (a volume, in kelvin, first channel) would radiate if it were black:
/// scale x blackbody(T), from a table in T that is fine enough for the eye (4096 steps).
class BlackbodyVolume final : public Volume {
 public:
  /// Throws std::invalid_argument unless scale >= 0 and finite.
  BlackbodyVolume(std::shared_ptr<const Volume> temperature, float scale);

  Spectrum eval(const Vec3& p) const override { return radiance(temperature_->eval(p)[0]); }
  ValueRange range(const Bounds3& box) const override {
    const ValueRange t = temperature_->range(box);
    return {radiance(t.min[0]), radiance(t.max[0]), radiance(t.mean[0])};
  }
  const Bounds3& bounds() const override { return temperature_->bounds(); }
  Vec3 resolution() const override { return temperature_->resolution(); }

 private:
  Spectrum radiance(float temperature) const;

  std::shared_ptr<const Volume> temperature_;
  float step_ = 1;               ///< kelvin between entries of the table
  std::vector<Spectrum> table_;  ///< from 0 K to the highest temperature
};

}  // namespace turbid
