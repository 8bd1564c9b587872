// BSDFs: what surfaces do to light. Parameters and defaults are Mitsuba 3's.
#include "scene/builder.h"
#include "scene/index_reader.h"
#include "surface/blend.h"
#include "surface/bump_map.h"
#include "surface/conductor.h"
#include "surface/dielectric.h"
#include "surface/diffuse.h"
#include "surface/indices.h"
#include "surface/mask.h"
#include "surface/normal_map.h"
#include "surface/null.h"
#include "surface/plastic.h"
#include "surface/principled.h"
#include "surface/principled_thin.h"
#include "surface/rough_dielectric.h"
#include "surface/two_sided.h"
#include "texture/constant.h"
#include "texture/mesh_attribute.h"

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

/// A parameter in [0, 1] that a texture may give.
Parameter share(const char* name, const char* default_text, const char* meaning) {
  return {name, kTexture, default_text, meaning, kUnitInterval};
}
Parameter sampling_rate(const char* name, const char* lobe) {
  return {name, kFloat, "1", std::string("how often ") + lobe + " is sampled, relative to the others", kNonNegative};
}

/// Parameters of both principled materials.
const Parameters kPrincipled = {
    share("base_color", "0.5", "colour of the base and of metal"),
    share("roughness", "0.5", "of the main lobes: the square root of alpha"),
    share("anisotropic", "0", "draws highlights out along u"),
    share("spec_trans", "0", "share of the light that is refracted instead of scattered by the base"),
    share("spec_tint", "0", "tint of reflections by the base colour"),
    share("sheen", "0", "light of fibres at grazing angles"),
    share("sheen_tint", "0", "tint of the sheen by the base colour"),
    share("flatness", "0", "the base as if light scattered beneath it")};

std::shared_ptr<const Bsdf> make_principled(const Properties& p, Builder& b) {
  if (p.has("eta") && p.has("specular")) p.refuse("specular", "cannot stand beside 'eta'");
  PrincipledParameters q;
  q.base_color = b.texture(p, "base_color");
  q.roughness = b.texture(p, "roughness");
  q.anisotropic = b.texture(p, "anisotropic");
  q.metallic = b.texture(p, "metallic");
  q.spec_trans = b.texture(p, "spec_trans");
  q.spec_tint = b.texture(p, "spec_tint");
  q.sheen = b.texture(p, "sheen");
  q.sheen_tint = b.texture(p, "sheen_tint");
  q.flatness = b.texture(p, "flatness");
  q.clearcoat = b.texture(p, "clearcoat");
  q.clearcoat_gloss = b.texture(p, "clearcoat_gloss");
  q.diffuse_rate = p.number("diffuse_reflectance_sampling_rate");
  q.specular_rate = p.number("main_specular_sampling_rate");
  q.clearcoat_rate = p.number("clearcoat_sampling_rate");
  if (p.has("eta")) {
    q.eta = p.number("eta");
  } else {
    // Specular 0 would be an index of 1, where nothing is refracted: Mitsuba 3's way out.
    constexpr float kLeast = 1e-3f;
    const bool refracts = !q.spec_trans->is_constant() || !q.spec_trans->mean().is_black();
    const float specular = p.number("specular");
    q.eta = Principled::eta_of_specular(refracts && specular == 0 ? kLeast : specular);
  }
  return std::make_shared<Principled>(q);
}

std::shared_ptr<const Bsdf> make_principled_thin(const Properties& p, Builder& b) {
  PrincipledThinParameters q;
  q.base_color = b.texture(p, "base_color");
  q.roughness = b.texture(p, "roughness");
  q.anisotropic = b.texture(p, "anisotropic");
  q.spec_trans = b.texture(p, "spec_trans");
  q.eta = b.texture(p, "eta");
  q.spec_tint = b.texture(p, "spec_tint");
  q.sheen = b.texture(p, "sheen");
  q.sheen_tint = b.texture(p, "sheen_tint");
  q.flatness = b.texture(p, "flatness");
  q.diff_trans = b.texture(p, "diff_trans");
  q.specular_reflectance_rate = p.number("specular_reflectance_sampling_rate");
  q.specular_transmittance_rate = p.number("specular_transmittance_sampling_rate");
  q.diffuse_reflectance_rate = p.number("diffuse_reflectance_sampling_rate");
  q.diffuse_transmittance_rate = p.number("diffuse_transmittance_sampling_rate");
  return std::make_shared<PrincipledThin>(q);
}

const Parameters kTilt = {
    {"bsdf", kBsdf, kRequired, "the material"},
    {"flip_invalid_normals", kBoolean, "true", "normals that face away from the sensor are mirrored to face it"},
    {"use_shadowing_function", kBoolean, "true", "soften the edge of the shadow that the tilt casts"}};

TiltSettings tilt_of(const Properties& p) {
  return {p.boolean("flip_invalid_normals"), p.boolean("use_shadowing_function")};
}

std::shared_ptr<const Bsdf> make_bump_map(const Properties& p, Builder& b) {
  const auto height = b.texture(p, "texture");
  if (std::dynamic_pointer_cast<const MeshAttributeTexture>(height))
    p.refuse("texture", "cannot be a mesh attribute: its slope is not known");
  return std::make_shared<BumpMap>(height, p.number("scale"), b.bsdf(p, "bsdf"), tilt_of(p));
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
                   Builder& b) { return std::make_shared<Mask>(b.texture(p, "opacity"), b.bsdf(p, "bsdf")); }},
       {.name = "blendbsdf",
        .summary = "Two materials mixed.",
        .parameters = {{"weight", kTexture, "0.5", "of the second material; the first has the rest", kUnitInterval},
                       {"bsdf_0", kBsdf, kRequired, "the first material"},
                       {"bsdf_1", kBsdf, kRequired, "the second material"}},
        .make =
            [](const Properties& p, Builder& b) {
              return std::make_shared<Blend>(b.texture(p, "weight"), b.bsdf(p, "bsdf_0"), b.bsdf(p, "bsdf_1"));
            }},
       {.name = "bumpmap",
        .summary = "A material tilted as if a height field displaced the surface.",
        .parameters = join({{.name = "texture",
                             .type = kTexture,
                             .default_text = kRequired,
                             .meaning = "the height, scene units; any name will do",
                             .any_name = true},
                            {"scale", kFloat, "1", "factor of the height"}},
                           kTilt),
        .make = make_bump_map},
       {.name = "normalmap",
        .summary = "A material tilted by the normals in a picture.",
        .parameters = join({{"normalmap", kTexture, kRequired,
                             "colour c is the normal 2 c - 1 in the shading frame; a bitmap needs raw"}},
                           kTilt),
        .make =
            [](const Properties& p, Builder& b) {
              return std::make_shared<NormalMap>(b.texture(p, "normalmap"), b.bsdf(p, "bsdf"), tilt_of(p));
            }},
       {.name = "principled",
        .summary = "Burley's material for artists: from cloth to metal to glass.",
        .parameters = join(
            kPrincipled, {share("metallic", "0", "metal instead of a dielectric"),
                          {"eta", kFloat, kOptional, "index inside over index outside, instead of specular", kPositive},
                          {"specular", kFloat, "0.5", "reflectance at normal incidence over 0.08", kUnitInterval},
                          share("clearcoat", "0", "a second, colourless reflection"),
                          share("clearcoat_gloss", "0", "how sharp that is"),
                          sampling_rate("diffuse_reflectance_sampling_rate", "the base"),
                          sampling_rate("main_specular_sampling_rate", "reflection and refraction"),
                          sampling_rate("clearcoat_sampling_rate", "the coat")}),
        .make = make_principled},
       {.name = "principledthin",
        .summary = "A sheet of Burley's material: paper, leaves.",
        .parameters =
            join(kPrincipled, {{"eta", kTexture, "1.5", "index of the sheet over that around it", kPositive},
                               {"diff_trans", kTexture, "0", "diffuse light that goes through: 2 is all of it", {0, 2}},
                               sampling_rate("specular_reflectance_sampling_rate", "reflection"),
                               sampling_rate("specular_transmittance_sampling_rate", "refraction"),
                               sampling_rate("diffuse_reflectance_sampling_rate", "diffuse reflection"),
                               sampling_rate("diffuse_transmittance_sampling_rate", "diffuse transmission")}),
        .make = make_principled_thin}},
      {"hair", "measured", "measured_polarized", "pplastic", "polarizer", "retarder", "circular"});
  return table;
}

}  // namespace turbid
