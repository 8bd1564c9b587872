// Fresnel's equations against closed forms.
#include "surface/fresnel.h"

#include <gtest/gtest.h>

#include "core/gauss_legendre.h"
#include "surface/indices.h"

namespace turbid {
namespace {

TEST(FresnelDielectric, NormalIncidence) {
  for (const float eta : {1.5f, 1 / 1.5f, 1.33f, 2.419f, 1.0001f}) {
    const FresnelDielectric f = fresnel_dielectric(1, eta);
    EXPECT_NEAR(f.reflectance, sqr((eta - 1) / (eta + 1)), 1e-6f);
    EXPECT_EQ(f.cos_transmit, 1);
  }
}

TEST(FresnelDielectric, BrewsterAngleReflectsHalfOfOnePolarisation) {
  // tan(theta_B) = eta: r_p = 0 and r_s = (1 - eta^2)/(1 + eta^2).
  const float eta = 1.5f, cosine = 1 / std::sqrt(1 + eta * eta);
  EXPECT_NEAR(fresnel_dielectric(cosine, eta).reflectance, 0.5f * sqr((1 - eta * eta) / (1 + eta * eta)), 1e-6f);
}

TEST(FresnelDielectric, SpecialAngles) {
  EXPECT_EQ(fresnel_dielectric(0, 1.5f).reflectance, 1);
  EXPECT_EQ(fresnel_dielectric(0.3f, 1 / 1.5f).reflectance, 1);  // beyond the critical angle, cosine 0.745
  EXPECT_EQ(fresnel_dielectric(0.3f, 1 / 1.5f).cos_transmit, 0);
  EXPECT_LT(fresnel_dielectric(0.746f, 1 / 1.5f).reflectance, 1);
  for (const float cosine : {0.0f, 1e-6f, 0.5f, 1.0f})
    EXPECT_EQ(fresnel_dielectric(cosine, 1).reflectance, 0) << cosine;
  for (const float cosine : {0.0f, 1e-20f, 1e-4f, 1.0f})
    for (const float eta : {1e-3f, 0.5f, 0.999999f, 1.000001f, 3.0f, 1e3f}) {
      const FresnelDielectric f = fresnel_dielectric(cosine, eta);
      EXPECT_TRUE(f.reflectance >= 0 && f.reflectance <= 1) << cosine << " " << eta << " " << f.reflectance;
    }
}

TEST(FresnelDielectric, IsTheSameFromBothSides) {
  // Stokes: the reflectance along the refracted path backwards is the same.
  for (const float cosine : {0.05f, 0.3f, 0.7f, 0.99f}) {
    const FresnelDielectric f = fresnel_dielectric(cosine, 1.7f);
    EXPECT_NEAR(fresnel_dielectric(f.cos_transmit, 1 / 1.7f).reflectance, f.reflectance, 2e-5f) << cosine;
    EXPECT_NEAR(1 - sqr(f.cos_transmit), (1 - sqr(cosine)) / sqr(1.7f), 1e-6f);
  }
}

TEST(FresnelConductor, ClosedFormsAndLimits) {
  const Spectrum eta(0.143f, 0.375f, 1.442f), k(3.983f, 2.386f, 1.603f);
  const Spectrum normal = fresnel_conductor(1, eta, k);
  for (int c = 0; c < kChannels; ++c)
    EXPECT_NEAR(normal[c], (sqr(eta[c] - 1) + sqr(k[c])) / (sqr(eta[c] + 1) + sqr(k[c])), 1e-6f);
  EXPECT_NEAR(fresnel_conductor(0, eta, k).min(), 1, 1e-6f);
  // Without extinction it is a dielectric.
  for (const float cosine : {0.1f, 0.5f, 0.9f})
    EXPECT_NEAR(fresnel_conductor(cosine, Spectrum(1.5f), Spectrum(0.0f))[0],
                fresnel_dielectric(cosine, 1.5f).reflectance, 2e-6f);
  for (const float cosine : {0.0f, 0.3f, 1.0f})
    EXPECT_EQ(fresnel_conductor(cosine, Spectrum(0.0f), Spectrum(1.0f)), Spectrum(1.0f)) << "a perfect mirror";
}

TEST(FresnelDiffuse, AgreesWithKnownValues) {
  // From outside at 1.5: 0.09178 (Walsh 1926; Duntley 1942 gives the closed form); from inside 1 - (1 - F)/eta^2.
  const double outside = fresnel_diffuse_reflectance(1.5);
  EXPECT_NEAR(outside, 0.09178, 1e-5);
  EXPECT_NEAR(fresnel_diffuse_reflectance(1 / 1.5), 1 - (1 - outside) / 2.25, 1e-8);
  for (const double eta : {1.1, 1.33, 2.4}) {
    EXPECT_NEAR(fresnel_diffuse_reflectance(1 / eta), 1 - (1 - fresnel_diffuse_reflectance(eta)) / (eta * eta), 1e-8);
    // Walsh's closed form.
    const double n = eta, n2 = n * n, n4 = n2 * n2;
    const double walsh = 0.5 + (n - 1) * (3 * n + 1) / (6 * (n + 1) * (n + 1)) +
                         n2 * (n2 - 1) * (n2 - 1) / std::pow(n2 + 1, 3) * std::log((n - 1) / (n + 1)) -
                         2 * n2 * n * (n2 + 2 * n - 1) / ((n2 + 1) * (n4 - 1)) +
                         8 * n4 * (n4 + 1) / ((n2 + 1) * (n4 - 1) * (n4 - 1)) * std::log(n);
    EXPECT_NEAR(fresnel_diffuse_reflectance(eta), walsh, 1e-7) << eta;
  }
  EXPECT_EQ(fresnel_diffuse_reflectance(1), 0);
}

TEST(Indices, AreFoundByName) {
  EXPECT_EQ(find_index("water"), 1.333f);
  EXPECT_EQ(find_index("BK7"), 1.5046f);
  EXPECT_EQ(find_index("fused quartz"), 1.458f);
  EXPECT_FALSE(find_index("watr"));
  EXPECT_FALSE(find_index(""));
  EXPECT_EQ(named_indices().size(), 23u);
  ASSERT_TRUE(find_conductor("au"));
  // Gold reflects red most, blue least.
  const Spectrum gold = fresnel_conductor(1, find_conductor("Au")->eta, find_conductor("Au")->k);
  EXPECT_GT(gold[0], 0.9f);
  EXPECT_GT(gold[0], gold[1]);
  EXPECT_GT(gold[1], gold[2]);
  EXPECT_EQ(fresnel_conductor(0.5f, find_conductor("none")->eta, find_conductor("none")->k), Spectrum(1.0f));
  EXPECT_FALSE(find_conductor("unobtainium"));
}

}  // namespace
}  // namespace turbid
