// Facet distributions: normalised, sampled as they say, masked consistently.
#include "surface/microfacet.h"

#include "surface/bsdf_checks.h"

namespace turbid::testing {
namespace {

struct Case {
  MicrofacetType type;
  float alpha_u, alpha_v;
};
const Case kCases[] = {
    {MicrofacetType::kGgx, 0.1f, 0.1f},      {MicrofacetType::kGgx, 0.5f, 0.2f},      {MicrofacetType::kGgx, 1, 1},
    {MicrofacetType::kBeckmann, 0.1f, 0.1f}, {MicrofacetType::kBeckmann, 0.5f, 0.2f}, {MicrofacetType::kBeckmann, 1, 1},
};

TEST(Microfacets, ProjectedAreaIsOne) {
  for (const Case& c : kCases) {
    const MicrofacetDistribution distribution(c.type, c.alpha_u, c.alpha_v);
    EXPECT_NEAR(integrate_sphere([&](const Vec3& m) { return double(distribution.pdf_all(m)); }, 1e-5), 1, 2e-4);
  }
}

/// Smith's masking is what makes the visible facets cover the projected area: int g1(v, m) max(0, v.m) d(m) dm = v.z.
TEST(Microfacets, VisibleAreaIsTheProjectedArea) {
  for (const Case& c : kCases) {
    const MicrofacetDistribution distribution(c.type, c.alpha_u, c.alpha_v);
    for (const double cosine : {1.0, 0.7, 0.2, 0.02}) {
      const Vec3 v = direction(cosine);
      EXPECT_NEAR(integrate_sphere([&](const Vec3& m) { return double(distribution.pdf_visible(v, m)); }, 1e-5), 1,
                  3e-4)
          << cosine << " " << c.alpha_u;
    }
  }
}

ChiSquareSettings coarse() {
  ChiSquareSettings settings;
  settings.samples = 50'000;
  return settings;
}

TEST(Microfacets, SamplesFollowTheDensity) {
  for (const Case& c : kCases) {
    const MicrofacetDistribution distribution(c.type, c.alpha_u, c.alpha_v);
    for (const double cosine : {1.0, 0.6, 0.1, 1e-3}) {
      const Vec3 v = direction(cosine, 2.1);
      const ChiSquareResult visible = chi_square_sphere(
          [&](Rng& rng) -> std::optional<Vec3> { return distribution.sample_visible(v, Numbers(rng).u); },
          [&](const Vec3& m) { return double(distribution.pdf_visible(v, m)); }, coarse());
      EXPECT_TRUE(passes(visible, 30)) << int(c.type) << " " << c.alpha_u << " " << cosine << ": " << visible.report;
    }
    const ChiSquareResult all =
        chi_square_sphere([&](Rng& rng) -> std::optional<Vec3> { return distribution.sample_all(Numbers(rng).u); },
                          [&](const Vec3& m) { return double(distribution.pdf_all(m)); }, coarse());
    EXPECT_TRUE(passes(all, 30)) << int(c.type) << " " << c.alpha_u << ": " << all.report;
  }
}

/// Planted: the density of all normals is not that of visible ones; nor is one distribution the other.
TEST(Microfacets, WrongDensitiesAreFound) {
  const MicrofacetDistribution ggx(MicrofacetType::kGgx, 0.4f, 0.4f), beckmann(MicrofacetType::kBeckmann, 0.4f, 0.4f);
  const Vec3 v = direction(0.5);
  const auto sample = [&](Rng& rng) -> std::optional<Vec3> { return ggx.sample_visible(v, Numbers(rng).u); };
  EXPECT_FALSE(passes(chi_square_sphere(
                          sample, [&](const Vec3& m) { return double(ggx.pdf_all(m)); }, coarse()),
                      1000));
  EXPECT_FALSE(passes(chi_square_sphere(
                          sample, [&](const Vec3& m) { return double(beckmann.pdf_visible(v, m)); }, coarse()),
                      1000));
}

TEST(Microfacets, MaskingHasItsLimits) {
  for (const Case& c : kCases) {
    const MicrofacetDistribution distribution(c.type, c.alpha_u, c.alpha_v);
    const Vec3 n(0, 0, 1);
    EXPECT_NEAR(distribution.g1(n, n), 1, 1e-6f);
    EXPECT_LT(distribution.g1(direction(1e-4), direction(0.5)), 0.01f);
    EXPECT_EQ(distribution.g1(direction(0.5), -direction(0.5)), 0) << "the facet's back";
    EXPECT_GT(distribution.g1(direction(-0.5), -direction(0.5)), 0)
        << "the same facet seen from below needs v.m v.z > 0";
    EXPECT_EQ(distribution.d(Vec3(1, 0, 0)), 0);
    EXPECT_EQ(distribution.d(direction(-0.5)), 0);
  }
}

TEST(Microfacets, ExtremeInputsStayFinite) {
  Rng rng(1);
  for (const MicrofacetType type : {MicrofacetType::kGgx, MicrofacetType::kBeckmann}) {
    for (const float alpha : {0.0f, 1e-4f, 1e-2f, 1.0f, 10.0f}) {
      const MicrofacetDistribution distribution(type, alpha, alpha);
      for (const double cosine : {1.0, 0.5, 1e-3, 1e-7}) {
        const Vec3 v = direction(cosine);
        for (int i = 0; i < 200; ++i) {
          Vec2 u = Numbers(rng).u;
          if (i < 9)
            u = Vec2(i % 3 == 0   ? 0
                     : i % 3 == 1 ? 0.5f
                                  : kOneMinusEpsilon,
                     i / 3 == 0   ? 0
                     : i / 3 == 1 ? 0.5f
                                  : kOneMinusEpsilon);
          const Vec3 m = distribution.sample_visible(v, u), all = distribution.sample_all(u);
          ASSERT_NEAR(length(m), 1, 1e-4f);
          ASSERT_NEAR(length(all), 1, 1e-4f);
          ASSERT_GT(m.z, 0);
          ASSERT_TRUE(std::isfinite(distribution.pdf_visible(v, m)));
        }
      }
    }
  }
}

}  // namespace
}  // namespace turbid::testing
