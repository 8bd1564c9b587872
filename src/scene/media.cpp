// Media: what fills volumes. Lengths are scene units unless `unit` says otherwise.
#include <fmt/format.h>

#include "medium/henyey_greenstein.h"
#include "medium/homogeneous.h"
#include "medium/isotropic.h"
#include "medium/materials.h"
#include "scene/builder.h"

namespace turbid {
namespace {

using MediumTable = PluginTable<std::shared_ptr<const Medium>, Builder>;
using enum ParameterType;

/// What the file says of a medium, before units: scattering (perhaps reduced) and absorption.
struct Coefficients {
  Spectrum sigma_t, sigma_s, sigma_a;
  bool reduced = false;
  float g = 0;                   ///< of a measured material, when the file names no phase function
  double metres_per_length = 0;  ///< coefficients are per this length; 0: per scene unit
};

double metres_of(const std::string& unit) {
  if (unit.starts_with("mm")) return 1e-3;
  if (unit.starts_with("cm")) return 1e-2;
  return unit.starts_with("m") ? 1 : 0;
}

void refuse_beside(const Properties& p, const char* name, std::initializer_list<const char*> others) {
  for (const char* other : others)
    if (p.has(other)) p.refuse(other, fmt::format("cannot stand beside '{}'", name));
}

Coefficients read_material(const Properties& p) {
  refuse_beside(p, "material", {"sigma_t", "albedo", "sigma_s", "sigma_a", "reduced", "unit"});
  const std::string name = p.string("material");
  const Material* material = find_material(name);
  if (!material) {
    std::vector<std::string> names;
    for (const Material& known : materials()) names.emplace_back(known.name);
    p.refuse("material", "names the unknown material '" + name + "'" + suggestion(name, names));
  }
  return {.sigma_t = material->sigma_s + material->sigma_a,
          .sigma_s = material->sigma_s,
          .sigma_a = material->sigma_a,
          .reduced = material->reduced,
          .g = material->g.mean(),
          .metres_per_length = 1e-3};
}

Coefficients read_coefficients(const Properties& p, Builder& b) {
  if (p.has("material")) return read_material(p);
  Coefficients result;
  result.reduced = p.boolean("reduced");
  result.metres_per_length = metres_of(p.string("unit"));
  if (p.has("sigma_s") || p.has("sigma_a")) {
    refuse_beside(p, p.has("sigma_s") ? "sigma_s" : "sigma_a", {"sigma_t", "albedo"});
    result.sigma_s = b.spectrum(p, "sigma_s");
    result.sigma_a = b.spectrum(p, "sigma_a");
    result.sigma_t = result.sigma_s + result.sigma_a;
  } else {
    const Spectrum albedo = b.spectrum(p, "albedo");
    result.sigma_t = b.spectrum(p, "sigma_t");  // kept as it is: equal channels stay equal
    result.sigma_s = result.sigma_t * albedo;
    result.sigma_a = result.sigma_t * (Spectrum(1.0f) - albedo);
  }
  return result;
}

/// Factor from 1/length of the coefficients to 1/scene unit.
float scale_of(const Properties& p, const Builder& b, const Coefficients& coefficients) {
  const float scale = p.number("scale");
  if (coefficients.metres_per_length == 0) return scale;
  if (b.metres_per_unit() == 0) {
    const bool material = p.has("material");
    log_notice(fmt::format("{}: the integrator has no 'scene_unit', so {} is taken per scene unit", p.node().describe(),
                           material ? "mm^-1 of material '" + p.string("material") + "'" : p.string("unit")));
    return scale;
  }
  return scale * static_cast<float>(b.metres_per_unit() / coefficients.metres_per_length);
}

std::shared_ptr<const Medium> make_homogeneous(const Properties& p, Builder& b) {
  const Coefficients coefficients = read_coefficients(p, b);
  std::shared_ptr<const PhaseFunction> phase = b.phase(p, "phase");
  if (!phase && coefficients.g != 0)
    phase = std::make_shared<HenyeyGreensteinPhase>(coefficients.g);
  else if (!phase)
    phase = std::make_shared<IsotropicPhase>();
  Spectrum sigma_t = coefficients.sigma_t, sigma_s = coefficients.sigma_s;
  if (coefficients.reduced) {
    sigma_s /= 1 - phase->mean_cosine();
    sigma_t = sigma_s + coefficients.sigma_a;
  }
  const float scale = scale_of(p, b, coefficients);
  return std::make_shared<HomogeneousMedium>(sigma_t * scale, sigma_s * scale, phase);
}

}  // namespace

const MediumTable& medium_table() {
  static const MediumTable table(
      Category::kMedium,
      {{.name = "homogeneous",
        .summary =
            "The same everywhere. Given by sigma_t and albedo, by sigma_s and sigma_a, or by a measured material.",
        .parameters = {{"sigma_t", kSpectrum, "1", "extinction coefficient, 1/length", kNonNegative},
                       {"albedo", kSpectrum, "0.75", "part of the extinction that scatters", kUnitInterval},
                       {"sigma_s", kSpectrum, "0", "scattering coefficient, 1/length", kNonNegative},
                       {"sigma_a", kSpectrum, "0", "absorption coefficient, 1/length", kNonNegative},
                       {"scale", kFloat, "1", "factor of all coefficients", kNonNegative},
                       {.name = "unit",
                        .type = kString,
                        .default_text = "scene",
                        .meaning = "of the coefficients; takes effect with the integrator's scene_unit",
                        .choices = {"scene", "mm^-1", "cm^-1", "m^-1"}},
                       {"reduced", kBoolean, "false",
                        "the scattering given is sigma_s (1 - g), g of the phase function"},
                       {"material", kString, kOptional, "a measured medium: see `turbid list materials`"},
                       {"phase", kPhase, kOptional, "how it scatters; left out: isotropic, or the material's own"},
                       kPriority,
                       {"sample_emitters", kBoolean, "true", "accepted; no effect"},
                       {"has_spectral_extinction", kBoolean, "true", "accepted; no effect"}},
        .make = make_homogeneous},
       heterogeneous_row()});
  return table;
}

}  // namespace turbid
