#pragma once
#include <filesystem>

#include "scene/colorimetry.h"
#include "scene/element.h"

namespace turbid {

/// How a spectral parameter is meant, from the plugin that holds it and its name: Mitsuba's rule.
SpectralUse spectral_use(Category owner, const std::string& parameter);

/// <spectrum value="..."/>: one number, or wavelength:value pairs with increasing wavelengths in nm.
Spectrum read_spectrum(const std::string& text, SpectralUse use, const SourceLocation& where);

/// An .spd file: a wavelength in nm and a value per line, # begins a comment. Throws FileError.
SpectralCurve read_spectrum_file(const std::filesystem::path& path);

}  // namespace turbid
