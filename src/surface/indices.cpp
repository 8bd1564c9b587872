#include "surface/indices.h"

#include <algorithm>
#include <array>
#include <cctype>

namespace turbid {
namespace {

constexpr std::array kIndices = {
    NamedIndex{"vacuum", 1.0f},      NamedIndex{"helium", 1.000036f},        NamedIndex{"hydrogen", 1.000132f},
    NamedIndex{"air", 1.000277f},    NamedIndex{"carbon dioxide", 1.00045f}, NamedIndex{"water", 1.333f},
    NamedIndex{"acetone", 1.36f},    NamedIndex{"ethanol", 1.361f},          NamedIndex{"carbon tetrachloride", 1.461f},
    NamedIndex{"glycerol", 1.4729f}, NamedIndex{"benzene", 1.501f},          NamedIndex{"silicone oil", 1.52045f},
    NamedIndex{"bromine", 1.661f},   NamedIndex{"water ice", 1.31f},         NamedIndex{"fused quartz", 1.458f},
    NamedIndex{"pyrex", 1.47f},      NamedIndex{"acrylic glass", 1.49f},     NamedIndex{"polypropylene", 1.49f},
    NamedIndex{"bk7", 1.5046f},      NamedIndex{"sodium chloride", 1.544f},  NamedIndex{"amber", 1.55f},
    NamedIndex{"pet", 1.575f},       NamedIndex{"diamond", 2.419f},
};

/// Measured spectra of the luxpop.com collection (the files that Mitsuba names Ag, Al ...; Cr: from Palik, "Handbook of
/// Optical Constants of Solids"), turned into linear Rec. 709 as emission spectra are in Mitsuba 3's RGB mode: CIE 1931
/// observer, 360-830 nm, equal energy 1 has luminance 1. A spectrally constant value is therefore not quite grey.
constexpr std::array kConductors = {
    NamedConductor{"none", Spectrum(0, 0, 0), Spectrum(1, 1, 1)},
    NamedConductor{"Ag", Spectrum(0.155276f, 0.116728f, 0.138388f), Spectrum(4.828355f, 3.122222f, 2.146901f)},
    NamedConductor{"Al", Spectrum(1.657501f, 0.880405f, 0.521244f), Spectrum(9.223811f, 6.269502f, 4.837004f)},
    NamedConductor{"Au", Spectrum(0.143036f, 0.375307f, 1.442045f), Spectrum(3.982997f, 2.385556f, 1.603359f)},
    NamedConductor{"Cr", Spectrum(4.369668f, 2.916505f, 1.654905f), Spectrum(5.206547f, 4.231306f, 3.754699f)},
    NamedConductor{"Cu", Spectrum(0.201006f, 0.923749f, 1.102215f), Spectrum(3.913262f, 2.453045f, 2.142090f)},
};

bool same_word(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](unsigned char x, unsigned char y) { return std::tolower(x) == std::tolower(y); });
}

template <class Table>
auto find_by_name(const Table& table, std::string_view name) {
  return std::find_if(table.begin(), table.end(), [&](const auto& entry) { return same_word(entry.name, name); });
}

}  // namespace

std::span<const NamedIndex> named_indices() { return kIndices; }

std::optional<float> find_index(std::string_view name) {
  const auto found = find_by_name(kIndices, name);
  return found == kIndices.end() ? std::nullopt : std::optional(found->index);
}

std::span<const NamedConductor> named_conductors() { return kConductors; }

std::optional<NamedConductor> find_conductor(std::string_view name) {
  const auto found = find_by_name(kConductors, name);
  return found == kConductors.end() ? std::nullopt : std::optional(*found);
}

}  // namespace turbid
