#pragma once
#include <cmath>

namespace turbid {

/// Linear Rec. 709 (sRGB primaries, D65) to CIE XYZ (1931) and back, as matrices of rows; ITU-R BT.709-6.
inline constexpr double kRgbToXyz[3][3] = {
    {0.412453, 0.357580, 0.180423}, {0.212671, 0.715160, 0.072169}, {0.019334, 0.119193, 0.950227}};
inline constexpr double kXyzToRgb[3][3] = {
    {3.240479, -1.537150, -0.498535}, {-0.969256, 1.875991, 0.041556}, {0.055648, -0.204043, 1.057311}};

/// The curve of sRGB (IEC 61966-2-1): from the encoded value in [0, 1] to linear light in [0, 1], and back.
inline float srgb_to_linear(float v) { return v <= 0.04045f ? v / 12.92f : std::pow((v + 0.055f) / 1.055f, 2.4f); }
inline float linear_to_srgb(float v) { return v <= 0.0031308f ? 12.92f * v : 1.055f * std::pow(v, 1 / 2.4f) - 0.055f; }

}  // namespace turbid
