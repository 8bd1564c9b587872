#include "surface/indices.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <string>

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
    // The rest of the collection, as the renderer Tungsten lists it; it agrees with those above within 0.3 %.
    NamedConductor{"a-C", Spectrum(2.9441f, 2.22715f, 1.96817f), Spectrum(0.887433f, 0.799322f, 0.815286f)},
    NamedConductor{"AlAs", Spectrum(3.6051f, 3.23294f, 2.21756f), Spectrum(0.000667025f, 0, 0.00742612f)},
    NamedConductor{"AlSb", Spectrum(0, 4.14275f, 4.66977f), Spectrum(0, 0.0937665f, 1.30074f)},
    NamedConductor{"Be", Spectrum(4.18506f, 3.18506f, 2.78409f), Spectrum(3.83544f, 3.01013f, 2.86901f)},
    NamedConductor{"CsI", Spectrum(2.1449f, 1.70232f, 1.66242f), Spectrum(0, 0, 0)},
    NamedConductor{"Cu2O", Spectrum(3.54928f, 2.95206f, 2.73692f), Spectrum(0.113218f, 0.194666f, 0.600168f)},
    NamedConductor{"CuO", Spectrum(3.24538f, 2.44963f, 2.19741f), Spectrum(0.520274f, 0.570737f, 0.717225f)},
    NamedConductor{"d-C", Spectrum(2.71125f, 2.31858f, 2.22886f), Spectrum(0, 0, 0)},
    NamedConductor{"Hg", Spectrum(2.39893f, 1.44003f, 0.909551f), Spectrum(6.32763f, 4.37194f, 3.42179f)},
    NamedConductor{"HgTe", Spectrum(4.77953f, 3.231f, 2.66003f), Spectrum(1.63198f, 1.58082f, 1.72958f)},
    NamedConductor{"Ir", Spectrum(3.08641f, 2.08219f, 1.61789f), Spectrum(5.59215f, 4.06718f, 3.26726f)},
    NamedConductor{"K", Spectrum(0.0640493f, 0.0464101f, 0.0381842f), Spectrum(2.10422f, 1.34894f, 0.913211f)},
    NamedConductor{"Li", Spectrum(0.265787f, 0.19561f, 0.22092f), Spectrum(3.54017f, 2.31113f, 1.66859f)},
    NamedConductor{"MgO", Spectrum(2.08959f, 1.65072f, 1.59488f), Spectrum(0, 0, 0)},
    NamedConductor{"Mo", Spectrum(4.4837f, 3.52546f, 2.77608f), Spectrum(4.11113f, 3.42087f, 3.1506f)},
    NamedConductor{"Na_palik", Spectrum(0.0602665f, 0.0561412f, 0.0619909f), Spectrum(3.17929f, 2.11248f, 1.57909f)},
    NamedConductor{"Nb", Spectrum(3.42014f, 2.79019f, 2.39559f), Spectrum(3.44138f, 2.73764f, 2.57991f)},
    NamedConductor{"Ni_palik", Spectrum(2.36728f, 1.66336f, 1.46706f), Spectrum(4.49883f, 3.05016f, 2.34543f)},
    NamedConductor{"Rh", Spectrum(2.5858f, 1.86019f, 1.55443f), Spectrum(6.78229f, 4.70295f, 3.97609f)},
    NamedConductor{"Se", Spectrum(4.05926f, 2.84269f, 2.82076f), Spectrum(0.754379f, 0.638515f, 0.521587f)},
    NamedConductor{"SiC", Spectrum(3.17235f, 2.52597f, 2.47936f), Spectrum(7.284e-07f, 0, 1.0015e-05f)},
    NamedConductor{"SnTe", Spectrum(4.52519f, 1.98115f, 1.28168f), Spectrum(0, 0, 0)},
    NamedConductor{"Ta", Spectrum(2.06258f, 2.39309f, 2.62807f), Spectrum(2.40805f, 1.74137f, 1.94704f)},
    NamedConductor{"Te", Spectrum(7.39084f, 4.4821f, 2.63707f), Spectrum(3.25614f, 3.52739f, 3.29217f)},
    NamedConductor{"ThF4", Spectrum(1.83072f, 1.44223f, 1.38765f), Spectrum(0, 0, 0)},
    NamedConductor{"TiC", Spectrum(3.70047f, 2.83744f, 2.5823f), Spectrum(3.26569f, 2.35156f, 2.17279f)},
    NamedConductor{"TiN", Spectrum(1.64847f, 1.15045f, 1.37978f), Spectrum(3.36846f, 1.94349f, 1.10201f)},
    NamedConductor{"TiO2", Spectrum(3.45662f, 2.80171f, 2.90515f), Spectrum(0.000102666f, 0, 0.00063569f)},
    NamedConductor{"VC", Spectrum(3.65757f, 2.75273f, 2.53268f), Spectrum(3.06835f, 2.19867f, 1.96318f)},
    NamedConductor{"V_palik", Spectrum(4.27751f, 3.51315f, 2.76113f), Spectrum(3.49118f, 2.88936f, 3.1117f)},
    NamedConductor{"VN", Spectrum(2.8656f, 2.11918f, 1.94008f), Spectrum(3.03233f, 2.05611f, 1.61629f)},
    NamedConductor{"W", Spectrum(4.3707f, 3.3003f, 2.99827f), Spectrum(3.50068f, 2.60487f, 2.27319f)},
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
  auto found = find_by_name(kConductors, name);
  // Some of the collection's names say that the data are Palik's; people write them with or without.
  constexpr std::string_view kSource = "_palik";
  if (found == kConductors.end() && name.ends_with(kSource))
    found = find_by_name(kConductors, name.substr(0, name.size() - kSource.size()));
  if (found == kConductors.end()) found = find_by_name(kConductors, std::string(name) + std::string(kSource));
  return found == kConductors.end() ? std::nullopt : std::optional(*found);
}

}  // namespace turbid
