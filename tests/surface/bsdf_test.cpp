// Every BSDF against what all BSDFs must satisfy; and planted errors, which the same checks must find.
#include "surface/bsdf.h"

#include "core/warp.h"
#include "surface/bsdf_checks.h"
#include "surface/materials.h"

namespace turbid::testing {
namespace {

TEST(Bsdf, SamplesFollowTheirDensity) {
  for (const Material& material : smooth_materials()) expect_right_sampler(*material.bsdf, material.name);
}

TEST(Bsdf, WeightIsValueOverDensityAtTheSamples) {
  for (const Material& material : smooth_materials())
    expect_coherent_samples(*material.bsdf, material.name, material.tolerance, material.reciprocal);
}

TEST(Bsdf, IsReciprocalInBothModes) {
  for (const Material& material : smooth_materials()) {
    if (material.name.starts_with("two-sided gold")) continue;  // checked on its halves
    expect_reciprocal(*material.bsdf, material.eta, material.name, 10 * material.tolerance, material.reciprocal);
  }
}

TEST(Bsdf, CreatesNoEnergy) {
  for (const Material& material : smooth_materials())
    expect_energy_bounded(*material.bsdf, material.name, material.energy);
}

/// Sharp lobes down to the smallest roughness: finite, coherent, and the energy of a smooth surface. A half vector made
/// anew from float directions does not resolve these peaks, so only the samples themselves are checked.
TEST(Bsdf, StaysFiniteAtTheSmallestRoughness) {
  const SurfacePoint point;
  for (const MicrofacetType type : {MicrofacetType::kGgx, MicrofacetType::kBeckmann}) {
    for (const float alpha : {0.0f, 1e-4f, 1e-3f}) {
      const RoughDielectric glass(1.5f, 1, roughness(type, alpha));
      const RoughConductor mirror(nullptr, nullptr, roughness(type, alpha));
      for (const Vec3& given : given_directions()) {
        EXPECT_NEAR(sampled_energy(glass, given).mean, 1, alpha < 1e-3f ? 2e-3 : 2e-2) << alpha << " " << given.z;
        if (given.z > 0) {
          EXPECT_NEAR(sampled_energy(mirror, given).mean, 1, alpha < 1e-3f ? 2e-3 : 2e-2);
        }
        Rng rng(5);
        for (int i = 0; i < 200; ++i) {
          const Numbers n(rng);
          for (const Bsdf* bsdf : {static_cast<const Bsdf*>(&glass), static_cast<const Bsdf*>(&mirror)}) {
            const auto sample = bsdf->sample(point, given, n.lobe, n.u, TransportMode::kRadiance);
            if (!sample) continue;
            ASSERT_TRUE(sample->weight.is_finite() && std::isfinite(sample->pdf_w));
            const Bsdf::Eval eval = bsdf->eval(point, given, sample->direction, TransportMode::kRadiance);
            ASSERT_TRUE(eval.value.is_finite() && std::isfinite(eval.pdf_w));
          }
        }
      }
    }
  }
}

TEST(Bsdf, IsEmptyAtGrazingAngles) {
  const SurfacePoint point;
  for (const Material& material : smooth_materials()) {
    for (const TransportMode mode : {TransportMode::kRadiance, TransportMode::kImportance}) {
      const Bsdf::Eval a = material.bsdf->eval(point, Vec3(1, 0, 0), direction(0.5), mode);
      const Bsdf::Eval b = material.bsdf->eval(point, direction(0.5), Vec3(1, 0, 0), mode);
      EXPECT_TRUE(a.value.is_black() && a.pdf_w == 0) << material.name;
      EXPECT_TRUE(b.value.is_black() && b.pdf_w == 0) << material.name;
      const auto sample = material.bsdf->sample(point, Vec3(1, 0, 0), 0.1f, Vec2(0.3f, 0.6f), mode);
      EXPECT_TRUE(!sample || (sample->flags & lobe::kNull)) << material.name;
    }
  }
}

/// Any index, roughness and direction: finite, never negative, densities never NaN.
TEST(Bsdf, RandomExtremesStayFinite) {
  const SurfacePoint point;
  Rng rng(23);
  const auto log_uniform = [&](double low, double high) {
    return static_cast<float>(low * std::pow(high / low, rng.next_double()));
  };
  for (int i = 0; i < 300; ++i) {
    const float index = i % 10 == 0 ? std::nextafter(1.0f, 2.0f) : log_uniform(0.05, 20);
    const auto type = i % 2 ? MicrofacetType::kGgx : MicrofacetType::kBeckmann;
    const Roughness r = roughness(type, log_uniform(1e-5, 3), i % 3 ? 0 : log_uniform(1e-5, 3), i % 4 != 0);
    std::vector<BsdfPtr> bsdfs = {
        std::make_shared<Dielectric>(index, 1.0f), std::make_shared<ThinDielectric>(index, 1.0f),
        std::make_shared<RoughDielectric>(index, 1.0f, r, nullptr, nullptr, i % 30 == 0),
        std::make_shared<RoughConductor>(constant(log_uniform(1e-3, 20)), constant(log_uniform(1e-3, 20)), r, nullptr,
                                         i % 30 == 0),
        std::make_shared<Plastic>(index, 1.0f, constant(1))};
    const auto unit = [&] { return constant(i % 5 ? rng.next_float() : std::round(rng.next_float())); };
    bsdfs.push_back(std::make_shared<Principled>(PrincipledParameters{.base_color = unit(),
                                                                      .roughness = unit(),
                                                                      .anisotropic = unit(),
                                                                      .metallic = unit(),
                                                                      .spec_trans = unit(),
                                                                      .spec_tint = unit(),
                                                                      .sheen = unit(),
                                                                      .sheen_tint = unit(),
                                                                      .flatness = unit(),
                                                                      .clearcoat = unit(),
                                                                      .clearcoat_gloss = unit(),
                                                                      .eta = index}));
    bsdfs.push_back(std::make_shared<PrincipledThin>(PrincipledThinParameters{.base_color = unit(),
                                                                              .roughness = unit(),
                                                                              .anisotropic = unit(),
                                                                              .spec_trans = unit(),
                                                                              .eta = constant(index),
                                                                              .spec_tint = unit(),
                                                                              .sheen = unit(),
                                                                              .flatness = unit(),
                                                                              .diff_trans = unit()}));
    bsdfs.push_back(std::make_shared<Blend>(unit(), bsdfs[0], bsdfs[2]));
    const Vec3 normal = square_to_sphere({rng.next_float(), rng.next_float()});
    bsdfs.push_back(std::make_shared<NormalMap>(normal_color(normal), bsdfs[i % 2 ? 2 : 5], TiltSettings{i % 3 != 0}));
    for (int j = 0; j < 60; ++j) {
      const Vec3 given =
          direction((j % 2 ? 1 : -1) * double(j % 3 ? log_uniform(1e-9, 1) : rng.next_float()), 6 * rng.next_double());
      Numbers n(rng);
      if (j == 0) n.lobe = 0;
      if (j == 1) n.lobe = kOneMinusEpsilon;
      for (const BsdfPtr& bsdf : bsdfs) {
        for (const TransportMode mode : {TransportMode::kRadiance, TransportMode::kImportance}) {
          const auto sample = bsdf->sample(point, given, n.lobe, n.u, mode);
          if (!sample) continue;
          ASSERT_TRUE(sample->weight.is_finite() && sample->weight.min() >= 0) << index << " " << given.z;
          ASSERT_TRUE(std::isfinite(sample->pdf_w) && sample->pdf_w >= 0) << index << " " << given.z;
          ASSERT_NEAR(length(sample->direction), 1, 1e-3f) << index << " " << given.z;
          const Vec3 other = direction(2 * rng.next_double() - 1);
          for (const Vec3& chosen : {sample->direction, other, -given, given}) {
            const Bsdf::Eval eval = bsdf->eval(point, given, chosen, mode);
            ASSERT_TRUE(eval.value.is_finite() && eval.value.min() >= 0) << index << " " << given.z;
            ASSERT_TRUE(std::isfinite(eval.pdf_w) && eval.pdf_w >= 0) << index << " " << given.z;
          }
        }
      }
    }
  }
}

// ---- Planted errors -------------------------------------------------------------------------------------------------

TEST(BsdfChecks, RefuseADensityWithAWrongFactor) {
  const RoughDielectric glass(1.5f, 1, roughness(MicrofacetType::kGgx, 0.3f));
  for (const double factor : {0.95, 1.05})
    EXPECT_FALSE(passes(chi_square_bsdf(glass, direction(0.6), TransportMode::kRadiance, factor), 1000));
}

/// Wraps a BSDF and swaps its directions in eval(): the density then belongs to another given direction.
class Swapped final : public Bsdf {
 public:
  explicit Swapped(BsdfPtr nested) : nested_(std::move(nested)) {}
  lobe::Flags flags() const override { return nested_->flags(); }
  Eval eval(const SurfacePoint& p, const Vec3& given, const Vec3& chosen, TransportMode mode) const override {
    return nested_->eval(p, chosen, given, mode);
  }
  std::optional<BsdfSample> sample(const SurfacePoint& p, const Vec3& given, float u_lobe, const Vec2& u,
                                   TransportMode mode) const override {
    return nested_->sample(p, given, u_lobe, u, mode);
  }

 private:
  BsdfPtr nested_;
};

TEST(BsdfChecks, RefuseSwappedDirections) {
  const Swapped glass(std::make_shared<RoughDielectric>(1.5f, 1.0f, roughness(MicrofacetType::kGgx, 0.3f)));
  EXPECT_FALSE(passes(chi_square_bsdf(glass, direction(0.6), TransportMode::kRadiance), 1000));
}

/// A density of another roughness than the sampler's.
TEST(BsdfChecks, RefuseAnotherRoughness) {
  const SurfacePoint point;
  const RoughConductor sampled(nullptr, nullptr, roughness(MicrofacetType::kGgx, 0.30f));
  const RoughConductor claimed(nullptr, nullptr, roughness(MicrofacetType::kGgx, 0.32f));
  const Vec3 given = direction(0.6);
  const ChiSquareResult result = chi_square_sphere(
      [&](Rng& rng) -> std::optional<Vec3> {
        const Numbers n(rng);
        const auto s = sampled.sample(point, given, n.lobe, n.u, TransportMode::kRadiance);
        return s ? std::optional(s->direction) : std::nullopt;
      },
      [&](const Vec3& v) { return double(claimed.eval(point, given, v, TransportMode::kRadiance).pdf_w); });
  EXPECT_FALSE(passes(result, 1000)) << result.report;
}

}  // namespace
}  // namespace turbid::testing
