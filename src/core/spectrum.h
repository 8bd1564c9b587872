#pragma once
#include <algorithm>
#include <array>
#include <cmath>

namespace turbid {

/// Number of colour channels. Everything that loops over channels uses this constant.
inline constexpr int kChannels = 3;

/// A quantity per colour channel, linear RGB (Rec. 709 primaries). The unit is that of the quantity it holds.
class Spectrum {
 public:
  constexpr Spectrum() : values_{} {}
  explicit constexpr Spectrum(float v) : values_{v, v, v} {}
  constexpr Spectrum(float r, float g, float b) : values_{r, g, b} {}

  constexpr float& operator[](int c) { return values_[static_cast<size_t>(c)]; }
  constexpr float operator[](int c) const { return values_[static_cast<size_t>(c)]; }

  constexpr Spectrum& operator+=(const Spectrum& o) {
    return apply(o, [](float a, float b) { return a + b; });
  }
  constexpr Spectrum& operator-=(const Spectrum& o) {
    return apply(o, [](float a, float b) { return a - b; });
  }
  constexpr Spectrum& operator*=(const Spectrum& o) {
    return apply(o, [](float a, float b) { return a * b; });
  }
  constexpr Spectrum& operator/=(const Spectrum& o) {
    return apply(o, [](float a, float b) { return a / b; });
  }
  constexpr Spectrum& operator*=(float s) { return *this *= Spectrum(s); }
  constexpr Spectrum& operator/=(float s) { return *this *= 1.0f / s; }

  friend constexpr Spectrum operator+(Spectrum a, const Spectrum& b) { return a += b; }
  friend constexpr Spectrum operator-(Spectrum a, const Spectrum& b) { return a -= b; }
  friend constexpr Spectrum operator*(Spectrum a, const Spectrum& b) { return a *= b; }
  friend constexpr Spectrum operator/(Spectrum a, const Spectrum& b) { return a /= b; }
  friend constexpr Spectrum operator*(Spectrum a, float s) { return a *= s; }
  friend constexpr Spectrum operator*(float s, Spectrum a) { return a *= s; }
  friend constexpr Spectrum operator/(Spectrum a, float s) { return a /= s; }
  friend constexpr bool operator==(const Spectrum&, const Spectrum&) = default;

  constexpr float sum() const { return values_[0] + values_[1] + values_[2]; }
  constexpr float mean() const { return sum() / kChannels; }
  constexpr float max() const { return std::max({values_[0], values_[1], values_[2]}); }
  constexpr float min() const { return std::min({values_[0], values_[1], values_[2]}); }
  constexpr bool is_black() const { return values_[0] == 0 && values_[1] == 0 && values_[2] == 0; }
  bool is_finite() const { return std::isfinite(values_[0]) && std::isfinite(values_[1]) && std::isfinite(values_[2]); }

  /// Relative luminance of linear Rec. 709 (ITU-R BT.709-6).
  constexpr float luminance() const { return 0.212671f * values_[0] + 0.715160f * values_[1] + 0.072169f * values_[2]; }

 private:
  template <class F>
  constexpr Spectrum& apply(const Spectrum& o, F f) {
    for (size_t c = 0; c < kChannels; ++c) values_[c] = f(values_[c], o.values_[c]);
    return *this;
  }
  std::array<float, kChannels> values_;
};

inline Spectrum exp(const Spectrum& s) { return {std::exp(s[0]), std::exp(s[1]), std::exp(s[2])}; }
inline Spectrum sqrt(const Spectrum& s) { return {std::sqrt(s[0]), std::sqrt(s[1]), std::sqrt(s[2])}; }
inline Spectrum lerp(const Spectrum& a, const Spectrum& b, float t) { return a * (1 - t) + b * t; }

}  // namespace turbid
