#include "image/cascades.h"

#include <fmt/format.h>

#include <algorithm>

#include "image/color.h"

namespace turbid {
namespace {

/// No layer that a scene names has a colon in its name.
constexpr std::string_view kPrefix = "cascade:";

}  // namespace

Cascades::Cascades(const OutlierSettings& settings, size_t channel)
    : channel_(channel), inverse_base_(1 / settings.base) {
  double brightness = settings.start;
  for (double& b : brightness_) {
    b = brightness;
    brightness *= settings.base;
  }
}

std::optional<Cascades> Cascades::in(const Film& film, const std::optional<OutlierSettings>& settings) {
  const auto& names = film.layer_names();
  const auto first = std::ranges::find_if(names, is_cascade);
  if (!settings || first == names.end()) return {};
  return Cascades(*settings, static_cast<size_t>(first - names.begin()));
}

std::vector<std::string> Cascades::layer_names() {
  std::vector<std::string> names;
  for (size_t cascade = 0; cascade < kCount; ++cascade)
    for (const char* color : {"R", "G", "B"}) names.push_back(fmt::format("{}{}.{}", kPrefix, cascade, color));
  return names;
}

bool Cascades::is_cascade(std::string_view layer_name) { return layer_name.starts_with(kPrefix); }

std::array<CascadeShare, 2> Cascades::split(const Spectrum& sample) const {
  const auto v = static_cast<double>(sample.luminance());
  constexpr size_t kLast = kCount - 1;
  if (!(v > brightness_[0])) return {{{channel(0), sample}, {channel(0), Spectrum(0.0f)}}};
  if (v >= brightness_[kLast])
    return {{{channel(kLast), sample * static_cast<float>(brightness_[kLast] / v)}, {channel(kLast), Spectrum(0.0f)}}};
  size_t j = 0;
  while (v >= brightness_[j + 1]) ++j;
  const double lower = (brightness_[j] / v - inverse_base_) / (1 - inverse_base_);
  return {{{channel(j), sample * static_cast<float>(lower)}, {channel(j + 1), sample * static_cast<float>(1 - lower)}}};
}

void Cascades::add(std::span<double> layers, const Spectrum& sample) const {
  for (const CascadeShare& share : split(sample))
    for (int c = 0; c < kChannels; ++c)
      layers[share.channel + static_cast<size_t>(c)] += static_cast<double>(share.value[c]);
}

double Cascades::count(std::span<const double> layers, size_t cascade) const {
  double luminance = 0;
  for (size_t c = 0; c < kChannels; ++c) luminance += kRgbToXyz[1][c] * layers[channel(cascade) + c];
  return luminance / brightness_[cascade];
}

}  // namespace turbid
