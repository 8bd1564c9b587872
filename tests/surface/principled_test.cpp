// The principled materials where they are something simpler, and what they refuse.
#include "surface/principled.h"

#include "surface/bsdf_checks.h"
#include "surface/fresnel.h"
#include "surface/materials.h"

namespace turbid::testing {
namespace {

const SurfacePoint kPoint;
constexpr auto kRadiance = TransportMode::kRadiance;

/// Pairs of directions on one side or on two.
std::vector<std::pair<Vec3, Vec3>> pairs(double given_sign, double chosen_sign) {
  std::vector<std::pair<Vec3, Vec3>> result;
  Rng rng(2);
  for (int i = 0; i < 200; ++i)
    result.emplace_back(direction(given_sign * (0.02 + 0.97 * rng.next_double()), 6 * rng.next_double()),
                        direction(chosen_sign * (0.02 + 0.97 * rng.next_double()), 6 * rng.next_double()));
  return result;
}

double schlick(double cosine) { return std::pow(1 - cosine, 5); }

TEST(Principled, GlassIsRoughDielectric) {
  // White, all refracting: the same microfacets.
  const Principled glass({.base_color = constant(1), .roughness = constant(0.5f), .spec_trans = constant(1)});
  const RoughDielectric rough(1.5f, 1, roughness(MicrofacetType::kGgx, 0.25f));
  for (const double side : {1.0, -1.0}) {
    for (const double other : {1.0, -1.0}) {
      for (const auto& [given, chosen] : pairs(side, other)) {
        for (const TransportMode mode : {kRadiance, TransportMode::kImportance}) {
          const Bsdf::Eval a = glass.eval(kPoint, given, chosen, mode), b = rough.eval(kPoint, given, chosen, mode);
          EXPECT_NEAR(a.value[1], b.value[1], 1e-4f * b.value[1]);
          EXPECT_NEAR(a.pdf_w, b.pdf_w, 1e-4f * b.pdf_w);
        }
      }
    }
  }
}

TEST(Principled, MetalIsAMirrorOfFacetsTimesSchlick) {
  const Spectrum base(0.9f, 0.6f, 0.3f);
  const Principled metal({.base_color = constant(0.9f, 0.6f, 0.3f),
                          .roughness = constant(0.6f),
                          .anisotropic = constant(0.4f),
                          .metallic = constant(1)});
  const float aspect = std::sqrt(1 - 0.9f * 0.4f);
  const RoughConductor mirror(nullptr, nullptr, roughness(MicrofacetType::kGgx, 0.36f / aspect, 0.36f * aspect));
  for (const auto& [given, chosen] : pairs(1, 1)) {
    const double weight = schlick(double(dot(given, normalize(given + chosen))));
    const Spectrum value = metal.eval(kPoint, given, chosen, kRadiance).value;
    const Spectrum facets = mirror.eval(kPoint, given, chosen, kRadiance).value;
    for (int c = 0; c < kChannels; ++c) {
      const double expected = double(facets[c]) * (double(base[c]) + (1 - double(base[c])) * weight);
      EXPECT_NEAR(double(value[c]), expected, 1e-4 * expected);
    }
  }
  EXPECT_TRUE(metal.eval(kPoint, direction(-0.5), direction(-0.4), kRadiance).value.is_black());
  EXPECT_FALSE(metal.sample(kPoint, direction(-0.5), 0.3f, Vec2(0.3f), kRadiance));
  EXPECT_EQ(metal.flags(), lobe::kReflection | lobe::kSmooth);
}

TEST(Principled, BaseIsBurleysDiffuse) {
  // Index 1: no reflection. f = base/pi ((1 - Fi/2)(1 - Fo/2) + R (Fo + Fi + Fo Fi (R - 1))), R = 2 r cos^2.
  const double r = 0.7;
  const Principled cloth({.base_color = constant(0.5f), .roughness = constant(float(r)), .eta = 1});
  const Principled fibres({.base_color = constant(0.5f), .sheen = constant(0.8f), .eta = 1});
  const Principled bare({.base_color = constant(0.5f), .eta = 1});
  for (const auto& [given, chosen] : pairs(1, 1)) {
    const double cos_d = double(dot(given, normalize(given + chosen))), cosine = double(chosen.z);
    const double fi = schlick(double(given.z)), fo = schlick(cosine), rr = 2 * r * cos_d * cos_d;
    const double f = (1 - fi / 2) * (1 - fo / 2) + rr * (fo + fi + fo * fi * (rr - 1));
    EXPECT_NEAR(double(cloth.eval(kPoint, given, chosen, kRadiance).value[0]), 0.5 / std::numbers::pi * f * cosine,
                1e-5);
    const Spectrum more =
        fibres.eval(kPoint, given, chosen, kRadiance).value - bare.eval(kPoint, given, chosen, kRadiance).value;
    EXPECT_NEAR(double(more[2]), 0.8 * schlick(cos_d) * cosine, 1e-5);
  }
}

TEST(Principled, SpecularMeansReflectanceAtNormalIncidence) {
  for (const float specular : {0.1f, 0.5f, 1.0f}) {
    const float eta = Principled::eta_of_specular(specular);
    EXPECT_NEAR(fresnel_dielectric(1, eta).reflectance, 0.08f * specular, 1e-6f);
  }
  EXPECT_NEAR(Principled::eta_of_specular(0.5f), 1.5f, 1e-6f);
  EXPECT_EQ(Principled::eta_of_specular(0), 1);
}

TEST(Principled, SamplingRatesChangeNothingButNoise) {
  PrincipledParameters p = everything();
  p.diffuse_rate = 0.2f;
  p.specular_rate = 3;
  p.clearcoat_rate = 0.5f;
  const Principled weighted(p), plain(everything());
  for (const auto& [given, chosen] : pairs(1, 1))
    EXPECT_EQ(weighted.eval(kPoint, given, chosen, kRadiance).value,
              plain.eval(kPoint, given, chosen, kRadiance).value);
  expect_right_sampler(weighted, "principled with other rates");
}

TEST(PrincipledThin, DiffuseSheetIsLambertianOnTheOtherSide) {
  // diff_trans = 2: all of it goes through.
  const PrincipledThin paper({.base_color = constant(0.6f), .diff_trans = constant(2)});
  for (const auto& [given, chosen] : pairs(1, -1)) {
    EXPECT_NEAR(paper.eval(kPoint, given, chosen, kRadiance).value[0], 0.6f * kInvPi * -chosen.z, 1e-6f);
    EXPECT_NEAR(paper.eval(kPoint, -given, -chosen, kRadiance).value[0], 0.6f * kInvPi * -chosen.z, 1e-6f);
  }
  for (const auto& [given, chosen] : pairs(-1, -1))
    EXPECT_TRUE(paper.eval(kPoint, given, chosen, kRadiance).value.is_black());
}

TEST(PrincipledThin, SpecularSheetReflectsAsFacetsAndPassesTheRestUnbent) {
  const PrincipledThin sheet(
      {.base_color = constant(0.6f), .roughness = constant(0.5f), .spec_trans = constant(1), .eta = constant(1.5f)});
  const RoughConductor facets(nullptr, nullptr, roughness(MicrofacetType::kGgx, 0.25f));
  const float scaled = sqr((0.65f * 1.5f - 0.35f) * 0.5f);
  const RoughConductor through(nullptr, nullptr, roughness(MicrofacetType::kGgx, scaled));
  for (const auto& [given, chosen] : pairs(1, 1)) {
    const float f = fresnel_dielectric(dot(given, normalize(given + chosen)), 1.5f).reflectance;
    const float mirror = facets.eval(kPoint, given, chosen, kRadiance).value[0];
    EXPECT_NEAR(sheet.eval(kPoint, given, chosen, kRadiance).value[0], f * mirror, 1e-4f * mirror);
    const Vec3 other(chosen.x, chosen.y, -chosen.z);
    if (dot(other, normalize(given + chosen)) >= 0) continue;
    const float passed = through.eval(kPoint, given, chosen, kRadiance).value[0];
    EXPECT_NEAR(sheet.eval(kPoint, given, other, kRadiance).value[0], 0.6f * (1 - f) * passed, 1e-4f * passed);
  }
}

TEST(Principled, RefusesImpossibleNumbers) {
  for (const float eta : {0.0f, -1.0f, std::nanf(""), kInfinity})
    EXPECT_THROW(Principled({.eta = eta}), std::invalid_argument);
  EXPECT_THROW(Principled({.clearcoat_rate = -1}), std::invalid_argument);
  EXPECT_THROW(PrincipledThin({.eta = constant(0)}), std::invalid_argument);
  EXPECT_THROW(PrincipledThin({.diffuse_transmittance_rate = -1}), std::invalid_argument);
}

}  // namespace
}  // namespace turbid::testing
