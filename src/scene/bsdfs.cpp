// BSDFs: what surfaces do to light. Parameters and defaults are Mitsuba 3's.
#include "scene/builder.h"
#include "surface/conductor.h"
#include "surface/dielectric.h"
#include "surface/diffuse.h"
#include "surface/indices.h"
#include "surface/mask.h"
#include "surface/null.h"
#include "surface/plastic.h"
#include "surface/rough_dielectric.h"
#include "surface/two_sided.h"
#include "texture/constant.h"

namespace turbid {
namespace {

using BsdfTable = PluginTable<std::shared_ptr<const Bsdf>, Builder>;
using enum ParameterType;
using Parameters = std::vector<Parameter>;

Parameters join(Parameters first, const Parameters& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

const Parameter kReflectanceFactor{"specular_reflectance", kTexture, "1", "factor of reflected light", kNonNegative};
const Parameter kTransmittanceFactor{"specular_transmittance", kTexture, "1", "factor of transmitted light",
                                     kNonNegative};
const Parameter kCompensation{"energy_compensation", kBoolean, "false",
                              "add the light that several bounces between facets would bring"};

/// Parameters of a boundary whose inside is of that material.
Parameters indices(const char* interior) {
  return {{"int_ior", kIor, interior, "index of refraction inside, or the name of a material", kPositive},
          {"ext_ior", kIor, "air", "index of refraction outside, or the name of a material", kPositive}};
}

const Parameters kRoughness = {
    {.name = "distribution",
     .type = kString,
     .default_text = "beckmann",
     .meaning = "of the facets' normals",
     .choices = {"beckmann", "ggx"}},
    {"alpha", kTexture, "0.1", "roughness: root mean square slope of the facets", kNonNegative},
    {"alpha_u", kTexture, kOptional, "roughness along u, instead of alpha", kNonNegative},
    {"alpha_v", kTexture, kOptional, "roughness along v, instead of alpha", kNonNegative},
    {"sample_visible", kBoolean, "true", "sample the facets that are seen (false: all of them, noisier)"}};

const Parameters kMetal = {
    {"material", kString, "none", "symbol of a metal (Au, Ag, Cu ...), instead of eta and k; none: a perfect mirror"},
    {"eta", kTexture, kOptional, "real part of the index of refraction", kNonNegative},
    {"k", kTexture, kOptional, "imaginary part of the index of refraction", kNonNegative},
    kReflectanceFactor};

/// An index of refraction: a number or the name of a material.
float index_of(const Properties& p, const std::string& name) {
  if (!p.is_string(name)) return p.number(name);
  const std::string material = p.string(name);
  if (const auto index = find_index(material)) return *index;
  std::vector<std::string> names;
  for (const NamedIndex& known : named_indices()) names.push_back(known.name);
  p.refuse(name, "names the unknown material '" + material + "'" + suggestion(material, names));
}

struct Metal {
  TexturePtr eta, k;
};

Metal metal_of(const Properties& p, Builder& builder) {
  const bool measured = p.has("eta") || p.has("k");
  if (!p.has("material") || p.string("material") == "none") return {builder.texture(p, "eta"), builder.texture(p, "k")};
  if (measured) p.refuse("material", "cannot stand beside 'eta' or 'k'");
  const std::string name = p.string("material");
  const auto metal = find_conductor(name);
  if (!metal) {
    std::vector<std::string> names;
    for (const NamedConductor& known : named_conductors()) names.push_back(known.name);
    p.refuse("material", "names the unknown metal '" + name + "'" + suggestion(name, names));
  }
  return {std::make_shared<ConstantTexture>(metal->eta), std::make_shared<ConstantTexture>(metal->k)};
}

MicrofacetType type_of(const Properties& p) {
  return p.string("distribution") == "ggx" ? MicrofacetType::kGgx : MicrofacetType::kBeckmann;
}

Roughness roughness_of(const Properties& p, Builder& builder) {
  Roughness roughness;
  roughness.type = type_of(p);
  roughness.sample_visible = p.boolean("sample_visible");
  if (p.has("alpha_u") != p.has("alpha_v"))
    p.refuse(p.has("alpha_u") ? "alpha_u" : "alpha_v", "needs both 'alpha_u' and 'alpha_v'");
  if (p.has("alpha_u") && p.has("alpha")) p.refuse("alpha", "cannot stand beside 'alpha_u' and 'alpha_v'");
  roughness.alpha_u = builder.texture(p, p.has("alpha_u") ? "alpha_u" : "alpha");
  if (p.has("alpha_v")) roughness.alpha_v = builder.texture(p, "alpha_v");
  return roughness;
}

/// Smooth and rough dielectrics with equal indices let light pass: said once, since it may be a slip.
void notice_equal_indices(const Properties& p) {
  if (index_of(p, "int_ior") == index_of(p, "ext_ior"))
    log_notice(p.node().describe() + " has equal indices of refraction: it is treated as 'null'");
}

template <class Smooth>
std::shared_ptr<const Bsdf> make_dielectric(const Properties& p, Builder& b) {
  notice_equal_indices(p);
  return std::make_shared<Smooth>(index_of(p, "int_ior"), index_of(p, "ext_ior"), b.texture(p, "specular_reflectance"),
                                  b.texture(p, "specular_transmittance"));
}

std::shared_ptr<const Bsdf> make_rough_dielectric(const Properties& p, Builder& b) {
  notice_equal_indices(p);
  return std::make_shared<RoughDielectric>(index_of(p, "int_ior"), index_of(p, "ext_ior"), roughness_of(p, b),
                                           b.texture(p, "specular_reflectance"), b.texture(p, "specular_transmittance"),
                                           p.boolean("energy_compensation"));
}

std::shared_ptr<const Bsdf> make_rough_plastic(const Properties& p, Builder& b) {
  return std::make_shared<RoughPlastic>(index_of(p, "int_ior"), index_of(p, "ext_ior"), type_of(p), p.number("alpha"),
                                        p.boolean("sample_visible"), b.texture(p, "diffuse_reflectance"),
                                        b.texture(p, "specular_reflectance"), p.boolean("nonlinear"));
}

const Parameters kDiffuseBase = {{"diffuse_reflectance", kTexture, "0.5", "reflectance of the base", kUnitInterval},
                                 {"nonlinear", kBoolean, "false", "the colour deepens by what the coat reflects back"},
                                 kReflectanceFactor};

}  // namespace

const BsdfTable& bsdf_table() {
  static const BsdfTable table(
      Category::kBsdf,
      {{.name = "diffuse",
        .summary = "Ideal diffuse reflection.",
        .parameters = {{"reflectance", kTexture, "0.5", "part of the light that is reflected", kUnitInterval}},
        .make = [](const Properties& p, Builder& b) { return std::make_shared<Diffuse>(b.texture(p, "reflectance")); }},
       {.name = "dielectric",
        .summary = "A smooth boundary of glass, water ...: reflects and refracts.",
        .parameters = join(indices("bk7"), {kReflectanceFactor, kTransmittanceFactor}),
        .make = make_dielectric<Dielectric>},
       {.name = "thindielectric",
        .summary = "A pane so thin that light passes undeflected.",
        .parameters = join(indices("bk7"), {kReflectanceFactor, kTransmittanceFactor}),
        .make =
            [](const Properties& p, Builder& b) {
              return std::make_shared<ThinDielectric>(index_of(p, "int_ior"), index_of(p, "ext_ior"),
                                                      b.texture(p, "specular_reflectance"),
                                                      b.texture(p, "specular_transmittance"));
            }},
       {.name = "roughdielectric",
        .summary = "A rough boundary of ground glass, wax ...: microfacets that reflect and refract.",
        .parameters = join(join(indices("bk7"), kRoughness), {kReflectanceFactor, kTransmittanceFactor, kCompensation}),
        .make = make_rough_dielectric},
       {.name = "conductor",
        .summary = "A smooth metal.",
        .parameters = kMetal,
        .make =
            [](const Properties& p, Builder& b) {
              const Metal metal = metal_of(p, b);
              return std::make_shared<Conductor>(metal.eta, metal.k, b.texture(p, "specular_reflectance"));
            }},
       {.name = "roughconductor",
        .summary = "A rough metal: microfacets that reflect.",
        .parameters = join(join(kMetal, kRoughness), {kCompensation}),
        .make =
            [](const Properties& p, Builder& b) {
              const Metal metal = metal_of(p, b);
              return std::make_shared<RoughConductor>(metal.eta, metal.k, roughness_of(p, b),
                                                      b.texture(p, "specular_reflectance"),
                                                      p.boolean("energy_compensation"));
            }},
       {.name = "plastic",
        .summary = "A diffuse base under a smooth dielectric coat.",
        .parameters = join(indices("polypropylene"), kDiffuseBase),
        .make =
            [](const Properties& p, Builder& b) {
              return std::make_shared<Plastic>(index_of(p, "int_ior"), index_of(p, "ext_ior"),
                                               b.texture(p, "diffuse_reflectance"),
                                               b.texture(p, "specular_reflectance"), p.boolean("nonlinear"));
            }},
       {.name = "roughplastic",
        .summary = "A diffuse base under a rough dielectric coat.",
        .parameters = join(join(indices("polypropylene"), kDiffuseBase),
                           {kRoughness[0],
                            {"alpha", kFloat, "0.1", "roughness: root mean square slope of the facets", kNonNegative},
                            kRoughness[4]}),
        .make = make_rough_plastic},
       {.name = "null",
        .summary = "A boundary that light does not notice: only the medium changes.",
        .parameters = {},
        .make = [](const Properties&, Builder&) { return std::make_shared<NullBsdf>(); }},
       {.name = "twosided",
        .summary = "Gives a reflecting material a second side.",
        .parameters = {{"bsdf", kBsdf, kRequired, "of the front, and of the back when no other is given"},
                       {"back", kBsdf, kOptional, "of the back"}},
        .make = [](const Properties& p,
                   Builder& b) { return std::make_shared<TwoSided>(b.bsdf(p, "bsdf"), b.bsdf(p, "back")); }},
       {.name = "mask",
        .summary = "A material with holes.",
        .parameters = {{"opacity", kTexture, "0.5", "weight of the material; the rest passes straight on",
                        kUnitInterval},
                       {"bsdf", kBsdf, kRequired, "the material"}},
        .make = [](const Properties& p,
                   Builder& b) { return std::make_shared<Mask>(b.texture(p, "opacity"), b.bsdf(p, "bsdf")); }}},
      {"blendbsdf", "bumpmap", "normalmap", "principled", "principledthin", "hair", "measured", "measured_polarized",
       "pplastic", "polarizer", "retarder", "circular"});
  return table;
}

}  // namespace turbid
