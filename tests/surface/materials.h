#pragma once
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "surface/blend.h"
#include "surface/conductor.h"
#include "surface/dielectric.h"
#include "surface/diffuse.h"
#include "surface/mask.h"
#include "surface/normal_map.h"
#include "surface/null.h"
#include "surface/plastic.h"
#include "surface/principled.h"
#include "surface/principled_thin.h"
#include "surface/rough_dielectric.h"
#include "surface/two_sided.h"
#include "texture/constant.h"

namespace turbid::testing {

inline TexturePtr constant(float v) { return std::make_shared<ConstantTexture>(v); }
inline TexturePtr constant(float r, float g, float b) { return std::make_shared<ConstantTexture>(Spectrum(r, g, b)); }

inline Roughness roughness(MicrofacetType type, float alpha_u, float alpha_v = 0, bool visible = true) {
  return {type, constant(alpha_u), alpha_v > 0 ? constant(alpha_v) : nullptr, visible};
}

struct Material {
  std::string name;
  BsdfPtr bsdf;
  float eta = 1;            ///< inside / outside, for reciprocity
  double tolerance = 1e-3;  ///< of values at samples, relative: sharper lobes lose digits
  double energy = 1.0005;   ///< most that may leave: some models make energy
  bool reciprocal = true;   ///< if not, the modes differ by more than the factor of refraction
};

/// Every lobe of the principled material at once.
inline PrincipledParameters everything() {
  return {.base_color = constant(0.7f, 0.5f, 0.2f),
          .roughness = constant(0.6f),
          .anisotropic = constant(0.5f),
          .metallic = constant(0.3f),
          .spec_trans = constant(0.4f),
          .spec_tint = constant(0.5f),
          .sheen = constant(0.5f),
          .sheen_tint = constant(0.4f),
          .flatness = constant(0.3f),
          .clearcoat = constant(0.8f),
          .clearcoat_gloss = constant(0.1f)};
}

inline PrincipledThinParameters everything_thin() {
  return {.base_color = constant(0.7f, 0.5f, 0.2f),
          .roughness = constant(0.6f),
          .anisotropic = constant(0.5f),
          .spec_trans = constant(0.4f),
          .eta = constant(1.4f),
          .spec_tint = constant(0.5f),
          .sheen = constant(0.5f),
          .sheen_tint = constant(0.4f),
          .flatness = constant(0.3f),
          .diff_trans = constant(0.7f)};
}

/// A colour that a normal map takes for the normal n.
inline TexturePtr normal_color(const Vec3& n) {
  const Vec3 c = (normalize(n) + Vec3(1)) * 0.5f;
  return constant(c.x, c.y, c.z);
}

/// Every material with smooth lobes.
inline std::vector<Material> smooth_materials() {
  using enum MicrofacetType;
  const TexturePtr gold_eta = constant(0.143f, 0.375f, 1.442f), gold_k = constant(3.983f, 2.386f, 1.603f);
  const auto glass = [](const Roughness& r, bool compensate = false, float inside = 1.5f) {
    return std::make_shared<RoughDielectric>(inside, 1.0f, r, nullptr, nullptr, compensate);
  };
  const auto metal = [&](const Roughness& r, bool compensate = false) {
    return std::make_shared<RoughConductor>(gold_eta, gold_k, r, nullptr, compensate);
  };
  const auto diffuse = std::make_shared<Diffuse>(constant(0.8f, 0.5f, 0.2f));
  return {
      {"diffuse", diffuse},
      {"glass ggx 0.5", glass(roughness(kGgx, 0.5f)), 1.5f},
      {"glass ggx 0.1", glass(roughness(kGgx, 0.1f)), 1.5f},
      {"glass ggx 0.02", glass(roughness(kGgx, 0.02f)), 1.5f, 1e-2},
      {"glass beckmann 0.3", glass(roughness(kBeckmann, 0.3f)), 1.5f},
      {"glass beckmann 0.05", glass(roughness(kBeckmann, 0.05f)), 1.5f, 1e-2},
      {"glass ggx anisotropic", glass(roughness(kGgx, 0.1f, 0.4f)), 1.5f},
      {"glass beckmann anisotropic", glass(roughness(kBeckmann, 0.5f, 0.2f)), 1.5f},
      {"glass ggx all normals", glass(roughness(kGgx, 0.3f, 0, false)), 1.5f},
      {"glass beckmann all normals", glass(roughness(kBeckmann, 0.3f, 0, false)), 1.5f},
      {"bubble ggx 0.3", glass(roughness(kGgx, 0.3f), false, 1 / 1.33f), 1 / 1.33f},
      {"glass ggx 0.3 compensated", glass(roughness(kGgx, 0.3f), true), 1.5f},
      {"glass beckmann 0.6 compensated", glass(roughness(kBeckmann, 0.6f), true), 1.5f},
      {"gold ggx 0.3", metal(roughness(kGgx, 0.3f))},
      {"gold ggx 0.05", metal(roughness(kGgx, 0.05f)), 1, 1e-2},
      {"gold beckmann anisotropic", metal(roughness(kBeckmann, 0.1f, 0.3f))},
      {"gold beckmann all normals", metal(roughness(kBeckmann, 0.2f, 0, false))},
      {"gold ggx all normals", metal(roughness(kGgx, 0.2f, 0, false))},
      {"gold ggx 0.5 compensated", metal(roughness(kGgx, 0.5f), true)},
      {"plastic", std::make_shared<Plastic>(1.49f, 1.0f, constant(0.6f, 0.3f, 0.1f))},
      {"plastic nonlinear", std::make_shared<Plastic>(1.9f, 1.0f, constant(0.6f, 0.3f, 0.1f), nullptr, true)},
      {"rough plastic ggx", std::make_shared<RoughPlastic>(1.49f, 1.0f, kGgx, 0.2f, true, constant(0.6f, 0.3f, 0.1f))},
      {"rough plastic beckmann",
       std::make_shared<RoughPlastic>(1.49f, 1.0f, kBeckmann, 0.1f, false, constant(0.6f), nullptr, true)},
      {"two-sided diffuse", std::make_shared<TwoSided>(diffuse)},
      {"two-sided gold and plastic",
       std::make_shared<TwoSided>(metal(roughness(kGgx, 0.3f)), std::make_shared<Plastic>(1.5f, 1.0f, nullptr))},
      {"blend of diffuse and rough glass",
       std::make_shared<Blend>(constant(0.3f), diffuse, glass(roughness(kGgx, 0.4f))), 1.5f},
      {"blend of gold and plastic", std::make_shared<Blend>(constant(0.6f), metal(roughness(kGgx, 0.3f)),
                                                            std::make_shared<Plastic>(1.5f, 1.0f, nullptr))},
      {"principled", std::make_shared<Principled>(PrincipledParameters{}), 1, 1e-3, 1.1},
      {"principled metal", std::make_shared<Principled>(PrincipledParameters{.base_color = constant(0.9f, 0.6f, 0.3f),
                                                                             .metallic = constant(1)})},
      {"principled glass",
       std::make_shared<Principled>(PrincipledParameters{
           .base_color = constant(1), .roughness = constant(0.4f), .spec_trans = constant(1), .eta = 1.33f}),
       1.33f},
      {"principled bubble",
       std::make_shared<Principled>(PrincipledParameters{.spec_trans = constant(0.5f), .eta = 0.8f}), 0.8f, 1e-3, 1.1},
      {"principled everything", std::make_shared<Principled>(everything()), 1.5f, 1e-3, 2},
      {"principled thin", std::make_shared<PrincipledThin>(PrincipledThinParameters{}), 1, 1e-3, 1.1},
      {"principled thin everything", std::make_shared<PrincipledThin>(everything_thin()), 1, 1e-3, 1.5, false},
      {"tilted diffuse", std::make_shared<NormalMap>(normal_color({0.5f, 0.3f, 0.8f}), diffuse), 1, 1e-3, 10, false},
      {"tilted gold",
       std::make_shared<NormalMap>(normal_color({-0.2f, 0.1f, 0.9f}), metal(roughness(kBeckmann, 0.2f, 0.4f))), 1, 1e-3,
       10, false},
      {"tilted glass", std::make_shared<NormalMap>(normal_color({0.3f, -0.3f, 0.9f}), glass(roughness(kGgx, 0.3f))),
       1.5f, 1e-3, 10, false},
      {"tilted diffuse, nothing mended",
       std::make_shared<NormalMap>(normal_color({0.5f, 0.3f, 0.8f}), diffuse, TiltSettings{false, false}), 1, 1e-3, 10,
       false},
      {"masked diffuse", std::make_shared<Mask>(constant(0.3f), diffuse)},
      {"masked rough glass", std::make_shared<Mask>(constant(0.7f), glass(roughness(kGgx, 0.3f))), 1.5f},
  };
}

}  // namespace turbid::testing
