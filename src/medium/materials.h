#pragma once
#include <optional>
#include <span>
#include <string_view>

#include "core/spectrum.h"

namespace turbid {

/// A measured medium, as its source prints it, for linear RGB.
struct Material {
  std::string_view name;
  Spectrum sigma_s;          ///< scattering coefficient, 1/mm; the reduced one, sigma_s (1 - g), when `reduced`
  Spectrum sigma_a;          ///< absorption coefficient, 1/mm
  Spectrum g;                ///< mean cosine of the phase function per channel; 0 where the source gives none
  bool reduced;              ///< sigma_s is the reduced coefficient: with it belongs an isotropic phase function
  std::optional<float> eta;  ///< index of refraction, where the source gives one
  std::string_view source;   ///< key in docs/references.bib
};

/// All measured media, in the order of their sources.
std::span<const Material> materials();

/// The one of that name (upper and lower case count alike); null: there is none.
const Material* find_material(std::string_view name);

}  // namespace turbid
