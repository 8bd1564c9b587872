#pragma once
#include <optional>
#include <span>
#include <string_view>

#include "core/spectrum.h"

namespace turbid {

/// The index of refraction of a transparent material.
struct NamedIndex {
  const char* name;
  float index;
};

/// Materials by name, 0 to 20 degrees Celsius, at about 589 nm (Hecht, "Optics", 4th ed., and as Mitsuba 3 lists them).
std::span<const NamedIndex> named_indices();
/// Upper and lower case are the same.
std::optional<float> find_index(std::string_view name);

/// The complex index eta - i k of a metal, per channel.
struct NamedConductor {
  const char* name;
  Spectrum eta, k;
};

/// Metals by their symbol, and "none": a perfect mirror (eta 0, k 1).
std::span<const NamedConductor> named_conductors();
/// Upper and lower case are the same.
std::optional<NamedConductor> find_conductor(std::string_view name);

}  // namespace turbid
