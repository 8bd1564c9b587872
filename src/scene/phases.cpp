// Phase functions: how media scatter. mu is the cosine of the deflection, g its mean.
#include "medium/blend_phase.h"
#include "medium/draine.h"
#include "medium/fournier_forand.h"
#include "medium/half_henyey_greenstein.h"
#include "medium/henyey_greenstein.h"
#include "medium/isotropic.h"
#include "medium/mie.h"
#include "medium/mie_fit.h"
#include "medium/rayleigh.h"
#include "medium/tabulated_phase.h"
#include "medium/two_term_henyey_greenstein.h"
#include "scene/builder.h"
#include "scene/index_reader.h"
#include "scene/values.h"

namespace turbid {
namespace {

using PhaseTable = PluginTable<std::shared_ptr<const PhaseFunction>, Builder>;
using enum ParameterType;

std::shared_ptr<const PhaseFunction> make_blend(const Properties& p, Builder& b) {
  const Spectrum weight = b.spectrum(p, "weight");
  if (weight.min() != weight.max()) p.refuse("weight", "must be one number");
  return std::make_shared<BlendPhase>(b.phase(p, "phase_0"), b.phase(p, "phase_1"), weight[0]);
}

std::shared_ptr<const PhaseFunction> make_tabulated(const Properties& p, Builder&) {
  std::vector<float> values;
  for (const double value : read_numbers(p.string("values"), p.where("values")))
    values.push_back(static_cast<float>(value));
  return std::make_shared<TabulatedPhase>(values);
}

/// Refuses what cannot be given together with `name`.
void stands_alone(const Properties& p, const std::string& name, const std::vector<std::string>& others) {
  for (const std::string& other : others)
    if (p.has(other)) p.refuse(other, "cannot stand beside '" + name + "'");
}

std::shared_ptr<const PhaseFunction> make_two_term(const Properties& p, Builder&) {
  if (p.has("preset")) {
    stands_alone(p, "preset", {"w", "g1", "g2"});
    return std::make_shared<TwoTermHenyeyGreensteinPhase>(two_term_preset(p.string("preset")));
  }
  for (const char* name : {"w", "g1", "g2"})
    if (!p.has(name)) throw std::invalid_argument("needs 'w', 'g1' and 'g2', or a 'preset'");
  return std::make_shared<TwoTermHenyeyGreensteinPhase>(
      TwoTermHenyeyGreensteinPhase::Terms{.w = p.number("w"), .g1 = p.number("g1"), .g2 = p.number("g2")});
}

template <HalfHenyeyGreensteinPhase::Hemisphere side>
std::shared_ptr<const PhaseFunction> make_half(const Properties& p, Builder&) {
  return std::make_shared<HalfHenyeyGreensteinPhase>(p.number("g"), side);
}

std::shared_ptr<const PhaseFunction> make_fournier_forand(const Properties& p, Builder&) {
  if (!p.has("backscatter"))
    return std::make_shared<FournierForandPhase>(
        FournierForandPhase::Parameters{.n = p.number("n"), .slope = p.number("slope")});
  stands_alone(p, "backscatter", {"n", "slope"});
  return std::make_shared<FournierForandPhase>(FournierForandPhase::from_backscatter(p.number("backscatter")));
}

std::shared_ptr<const PhaseFunction> make_mie(const Properties& p, Builder&) {
  return std::make_shared<MiePhase>(MiePhase::Parameters{.radius = p.number("radius"),
                                                         .deviation = p.number("deviation"),
                                                         .interior_ior = index_of(p, "int_ior"),
                                                         .interior_k = p.number("k"),
                                                         .exterior_ior = index_of(p, "ext_ior"),
                                                         .wavelength = p.number("wavelength")});
}

const Parameter kHalfG{"g", kFloat, "0.8", "of the whole function; the mean cosine of its half is another", kCosine};

}  // namespace

const PhaseTable& phase_table() {
  static const PhaseTable table(
      Category::kPhase,
      {{.name = "isotropic",
        .summary = "Every direction alike.",
        .parameters = {},
        .make = [](const Properties&, Builder&) { return std::make_shared<IsotropicPhase>(); }},
       {.name = "hg",
        .summary = "Henyey and Greenstein 1941.",
        .parameters = {{"g", kFloat, "0.8", "mean cosine: above 0 forward, below 0 backward", kCosine}},
        .make = [](const Properties& p, Builder&) { return std::make_shared<HenyeyGreensteinPhase>(p.number("g")); }},
       {.name = "rayleigh",
        .summary = "Particles much smaller than the wavelength.",
        .parameters = {},
        .make = [](const Properties&, Builder&) { return std::make_shared<RayleighPhase>(); }},
       {.name = "blendphase",
        .summary = "A mixture of two phase functions.",
        .parameters = {{"weight", kSpectrum, kRequired, "of the second one; the first has 1 - weight", kUnitInterval},
                       {"phase_0", kPhase, kRequired, "the first one"},
                       {"phase_1", kPhase, kRequired, "the second one"}},
        .make = make_blend},
       {.name = "tabphase",
        .summary = "Piecewise linear in the cosine.",
        .parameters = {{"values", kString, kRequired,
                        "two or more numbers at equally spaced mu from -1 to 1; their scale does not matter"}},
        .make = make_tabulated},
       {.name = "two_term_hg",
        .summary = "Two Henyey-Greenstein functions: w of the first, 1 - w of the second.",
        .parameters = {{"w", kFloat, kOptional, "weight of the first", kUnitInterval},
                       {"g1", kFloat, kOptional, "mean cosine of the first", kCosine},
                       {"g2", kFloat, kOptional, "mean cosine of the second", kCosine},
                       {.name = "preset",
                        .type = kString,
                        .default_text = kOptional,
                        .meaning = "instead of all others: fits of Hanika et al. 2022, Fig. 9",
                        .choices = two_term_presets()}},
        .make = make_two_term},
       {.name = "forward_hg",
        .summary = "The forward half of a Henyey-Greenstein function.",
        .parameters = {kHalfG},
        .make = make_half<HalfHenyeyGreensteinPhase::Hemisphere::kForward>},
       {.name = "backward_hg",
        .summary = "The backward half of a Henyey-Greenstein function.",
        .parameters = {kHalfG},
        .make = make_half<HalfHenyeyGreensteinPhase::Hemisphere::kBackward>},
       {.name = "draine",
        .summary = "Draine 2003: Henyey and Greenstein's times 1 + alpha mu^2; alpha 1 is Cornette and Shanks's.",
        .parameters = {{"g", kFloat, "0.8", "position of the peak; not the mean cosine unless alpha is 0", kCosine},
                       {"alpha", kFloat, "1", "strength of the factor", kNonNegative}},
        .make = [](const Properties& p,
                   Builder&) { return std::make_shared<DrainePhase>(p.number("g"), p.number("alpha")); }},
       {.name = "mie_fit",
        .summary = "Water droplets in air, as a fit to Mie by diameter (Jendersie and d'Eon 2023): fog, clouds.",
        .parameters = {{"diameter", kFloat, "10", "micrometres", Range{.min = 0, .max = 50, .open_min = true}}},
        .make = [](const Properties& p, Builder&) { return std::make_shared<MieFitPhase>(p.number("diameter")); }},
       {.name = "mie",
        .summary = "Spheres of any index, by the Lorenz-Mie series: droplets with rainbow and glory, milk, soot.",
        .parameters =
            {{"radius", kFloat, "5", "median, micrometres", kPositive},
             {"deviation", kFloat, "0.1", "standard deviation of ln(radius); 0: all alike", kUnitInterval},
             {"int_ior", kIor, "water", "index of refraction of the spheres, or the name of a material", kPositive},
             {"ext_ior", kIor, "air", "index of refraction around them, or the name of a material", kPositive},
             {"k", kFloat, "0", "imaginary part of the spheres' index", kNonNegative},
             {"wavelength", kFloat, "550", "in vacuum, nanometres; the same for all channels", kPositive}},
        .make = make_mie},
       {.name = "fournier_forand",
        .summary = "Particles in natural water: Fournier and Forand 1994, Fournier and Jonasz 1999.",
        .parameters = {{"n", kFloat, "1.1", "index of refraction relative to the water",
                        Range{.min = 1, .max = 1.35, .open_min = true}},
                       {"slope", kFloat, "3.5835", "Junge slope of the distribution of radii",
                        Range{.min = 3, .max = 5, .open_min = true, .open_max = true}},
                       {"backscatter", kFloat, kOptional,
                        "backward part, instead of both: n = 1.01 + 0.1542 (slope - 3)", Range{1e-4, 0.1}}},
        .make = make_fournier_forand}},
      {"sggx"});
  return table;
}

}  // namespace turbid
