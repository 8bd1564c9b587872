// Spectra as linear RGB, against published numbers.
#include "scene/colorimetry.h"

#include <gtest/gtest.h>

#include "scene/spectrum_reader.h"

namespace turbid::testing {
namespace {

// The sum over 1000 wavelengths that are 470/999 nm apart is multiplied by 470/1000, as in Mitsuba: 0.1 % too little;
// Mitsuba's normalisation of y is 0.1 % below the sum of the table, which makes up for it.
constexpr float kStepError = 2e-3f;

void expect_near(const Spectrum& value, const Spectrum& expected, float tolerance) {
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(value[c], expected[c], tolerance) << "channel " << c;
}

/// XYZ = (1, 1, 1) in Rec. 709 (C. Poynton, Frequently asked questions about color).
const Spectrum kEqualEnergy(1.204794f, 0.948292f, 0.908916f);

TEST(Colorimetry, EqualEnergyIsALittlePurple) {
  expect_near(constant_to_rgb(1, SpectralUse::kEmission), kEqualEnergy, 2e-6f);
  expect_near(curve_to_rgb({{360, 830}, {1, 1}}, SpectralUse::kEmission), kEqualEnergy, kStepError);
}

TEST(Colorimetry, AWhiteReflectanceIsWhite) {
  expect_near(curve_to_rgb({{360, 830}, {1, 1}}, SpectralUse::kReflectance), Spectrum(1.0f), kStepError);
  expect_near(curve_to_rgb({{360, 830}, {0.25, 0.25}}, SpectralUse::kReflectance), Spectrum(0.25f), kStepError);
  EXPECT_EQ(constant_to_rgb(0.25, SpectralUse::kReflectance), Spectrum(0.25f));
  expect_near(curve_to_rgb({{360, 830}, {3, 3}}, SpectralUse::kCoefficient), Spectrum(3.0f), 3 * kStepError);
}

TEST(Colorimetry, ReflectancesAreClampedAndOthersAreNot) {
  EXPECT_EQ(curve_to_rgb({{360, 830}, {5, 5}}, SpectralUse::kReflectance), Spectrum(1.0f));
  const Spectrum laser = curve_to_rgb({{520, 530}, {1, 1}}, SpectralUse::kEmission);
  EXPECT_EQ(laser[0], 0);  // outside of the gamut
  EXPECT_GT(laser[1], 0);
}

TEST(Colorimetry, TheUseFollowsFromPluginAndName) {
  EXPECT_EQ(spectral_use(Category::kEmitter, "radiance"), SpectralUse::kEmission);
  EXPECT_EQ(spectral_use(Category::kBsdf, "reflectance"), SpectralUse::kReflectance);
  EXPECT_EQ(spectral_use(Category::kBsdf, "eta"), SpectralUse::kCoefficient);
  EXPECT_EQ(spectral_use(Category::kMedium, "sigma_t"), SpectralUse::kCoefficient);
  EXPECT_EQ(spectral_use(Category::kMedium, "albedo"), SpectralUse::kReflectance);
}

}  // namespace
}  // namespace turbid::testing
