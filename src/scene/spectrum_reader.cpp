#include "scene/spectrum_reader.h"

#include <fmt/format.h>

#include <fstream>

#include "scene/values.h"

namespace turbid {
namespace {

/// Empty, or what is wrong with the curve.
std::string defect(const SpectralCurve& curve) {
  if (curve.wavelengths.size() < 2) return "a spectrum needs at least two wavelength:value pairs";
  for (size_t i = 1; i < curve.wavelengths.size(); ++i)
    if (!(curve.wavelengths[i] > curve.wavelengths[i - 1]))
      return fmt::format("wavelengths must increase, found {} before {}", curve.wavelengths[i - 1],
                         curve.wavelengths[i]);
  return {};
}

}  // namespace

SpectralUse spectral_use(Category owner, const std::string& parameter) {
  for (const char* name : {"eta", "k", "int_ior", "ext_ior", "sigma_t", "sigma_a", "sigma_s"})
    if (parameter == name) return SpectralUse::kCoefficient;
  return owner == Category::kEmitter ? SpectralUse::kEmission : SpectralUse::kReflectance;
}

Spectrum read_spectrum(const std::string& text, SpectralUse use, const SourceLocation& where) {
  const std::vector<std::string> words = split_words(text);
  if (words.empty()) throw SceneError(where, "expected a number or wavelength:value pairs, found nothing");
  if (words.size() == 1 && words[0].find(':') == std::string::npos)
    return constant_to_rgb(read_number(words[0], where), use);
  SpectralCurve curve;
  for (const std::string& word : words) {
    const size_t colon = word.find(':');
    if (colon == std::string::npos)
      throw SceneError(where, "'" + word + "' is not a wavelength:value pair (<rgb> takes three numbers)");
    curve.wavelengths.push_back(read_number(word.substr(0, colon), where));
    curve.values.push_back(read_number(word.substr(colon + 1), where));
  }
  if (const std::string message = defect(curve); !message.empty()) throw SceneError(where, message);
  return curve_to_rgb(curve, use);
}

SpectralCurve read_spectrum_file(const std::filesystem::path& path) {
  std::ifstream file(path);
  if (!file) throw FileError(path.string(), "cannot be read");
  SpectralCurve curve;
  int number = 0;
  for (std::string line; std::getline(file, line);) {
    ++number;
    const std::vector<std::string> words = split_words(line.substr(0, line.find('#')));
    if (words.empty()) continue;
    const SourceLocation where{path.string(), number, 1};
    if (words.size() != 2)
      throw SceneError(where, "expected a wavelength and a value, found " + std::to_string(words.size()) + " words");
    curve.wavelengths.push_back(read_number(words[0], where));
    curve.values.push_back(read_number(words[1], where));
  }
  if (const std::string message = defect(curve); !message.empty()) throw FileError(path.string(), message);
  return curve;
}

}  // namespace turbid
