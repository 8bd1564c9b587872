#pragma once
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "scene/document.h"

namespace turbid {

/// What kind of value a plugin expects for a parameter.
enum class ParameterType {
  kBoolean,
  kInteger,
  kFloat,  ///< also reads integers
  kString,
  kFile,  ///< a string, looked up in the search folders
  kPoint,
  kVector,
  kSpectrum,  ///< <rgb>, <spectrum>, <float>, or a texture or volume that is constant
  kTexture,   ///< as kSpectrum, or a <texture>
  kIor,       ///< index of refraction: a number, or the name of a material
  kTransform,
  kFloatOrString,
  kFloatOrVector,  ///< one plain number or three, as a spectrum
  // Plugins inside the plugin; their name in the file does not matter unless several parameters have the same type.
  kBsdf,
  kEmitter,
  kMedium,
  kPhase,
  kFilm,
  kSampler,
  kFilter,
  kIntegrator,
  kShape,
};
const char* to_string(ParameterType type);
/// True for the types from kBsdf on; kTexture is a value that may be a child.
bool is_plugin(ParameterType type);

/// Which finite numbers make sense; for spectra it holds per channel. NaN and infinity never do.
struct Range {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool open_min = false, open_max = false;  ///< the end itself is excluded

  bool contains(double v) const {
    return std::isfinite(v) && (open_min ? v > min : v >= min) && (open_max ? v < max : v <= max);
  }
  /// "at least 0", "above 0", "in [0, 1]", "in (-1, 1)"; "finite" without limits.
  std::string describe() const;
};
inline constexpr Range kAnyNumber{};
inline constexpr Range kNonNegative{0};
inline constexpr Range kPositive{.min = 0, .open_min = true};
inline constexpr Range kUnitInterval{0, 1};
inline constexpr Range kCosine{.min = -1, .max = 1, .open_min = true, .open_max = true};
inline constexpr Range kAtLeastOne{1};

/// Default texts with a meaning of their own.
inline constexpr const char* kRequired = "required";  ///< leaving it out is an error
inline constexpr const char* kOptional = "";          ///< absent unless given: ask Properties::has first

/// One row of a plugin's parameter list. The list drives reading, defaults, messages, `turbid list` and the reference.
struct Parameter {
  std::string name;
  ParameterType type;
  std::string default_text;               ///< as it would be written in value="..."; kRequired; kOptional
  std::string meaning;                    ///< one line, with the unit
  Range range = {};                       ///< of numbers
  std::vector<std::string> choices = {};  ///< of strings; empty: any
  bool any_name = false;                  ///< of kTexture: takes a texture whatever its name is in the file
};

}  // namespace turbid
