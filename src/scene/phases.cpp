// Phase functions: how media scatter. mu is the cosine of the deflection, g its mean.
#include "medium/blend_phase.h"
#include "medium/henyey_greenstein.h"
#include "medium/isotropic.h"
#include "medium/rayleigh.h"
#include "medium/tabulated_phase.h"
#include "scene/builder.h"
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
        .make = make_tabulated}},
      {"sggx"});
  return table;
}

}  // namespace turbid
