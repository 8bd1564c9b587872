#pragma once
#include <vector>

#include "core/spectrum.h"

namespace turbid {

/// A spectrum given by its values at increasing wavelengths (nm), linear in between, zero outside.
struct SpectralCurve {
  std::vector<double> wavelengths, values;
};

/// What a spectral curve stands for decides how it becomes linear RGB, as in Mitsuba 3's RGB variants.
enum class SpectralUse {
  kEmission,     ///< radiance and the like: equal energy stays what it is, which is not white in sRGB; >= 0
  kReflectance,  ///< seen under illuminant D65, so that 1 everywhere is white; clamped to [0, 1]
  kCoefficient,  ///< index of refraction, extinction ...: under D65 too, but only >= 0
};

/// Linear Rec. 709 of a curve: the CIE 1931 2-degree observer on 1000 wavelengths from 360 to 830 nm (the steps that
/// Mitsuba 3 takes), scaled so that equal energy 1, or D65 where that applies, has luminance 1. Colours outside of the
/// gamut are clamped with a warning.
Spectrum curve_to_rgb(const SpectralCurve& curve, SpectralUse use);

/// Linear Rec. 709 of the same value at every wavelength: grey, but for emission, where equal energy is a little
/// purple.
Spectrum constant_to_rgb(double value, SpectralUse use);

}  // namespace turbid
