#include "table/phase_moments.h"

#include <gtest/gtest.h>

#include "medium/blend_phase.h"
#include "medium/draine.h"
#include "medium/fournier_forand.h"
#include "medium/half_henyey_greenstein.h"
#include "medium/henyey_greenstein.h"
#include "medium/isotropic.h"
#include "medium/mie.h"
#include "medium/rayleigh.h"
#include "medium/tabulated_phase.h"
#include "medium/two_term_henyey_greenstein.h"

namespace turbid {
namespace {

TEST(PhaseMoments, OfHenyeyGreensteinArePowers) {
  for (const float g : {-0.9f, -0.3f, 0.0f, 1e-4f, 0.5f, 0.9f, 0.98f}) {
    const std::vector<double> f = legendre_moments(HenyeyGreensteinPhase(g), 64);
    for (int l = 0; l <= 64; ++l)
      EXPECT_NEAR(f[static_cast<size_t>(l)], std::pow(static_cast<double>(g), l), 1e-5) << "g " << g << ", l " << l;
  }
}

TEST(PhaseMoments, OfOthers) {
  const std::vector<double> rayleigh = legendre_moments(RayleighPhase(), 6);
  const double expected[] = {1, 0, 0.1, 0, 0, 0, 0};
  for (size_t l = 0; l < rayleigh.size(); ++l) EXPECT_NEAR(rayleigh[l], expected[l], 1e-6) << l;
  // f = (1 + 3 a mu)/(4 pi) from a table of two: 0 backward, twice the mean forward.
  const std::vector<double> table = legendre_moments(TabulatedPhase(std::array{0.0f, 3.0f}), 3);
  EXPECT_NEAR(table[1], 1.0 / 3, 1e-5);
  EXPECT_NEAR(table[2], 0, 1e-5);
}

TEST(PhaseMoments, TheFirstIsTheMeanCosine) {
  const std::vector<std::shared_ptr<const PhaseFunction>> phases = {
      std::make_shared<BlendPhase>(std::make_shared<HenyeyGreensteinPhase>(0.8f),
                                   std::make_shared<HenyeyGreensteinPhase>(-0.3f), 0.25f),
      std::make_shared<HalfHenyeyGreensteinPhase>(0.5f, HalfHenyeyGreensteinPhase::Hemisphere::kForward),
      std::make_shared<TwoTermHenyeyGreensteinPhase>(two_term_preset(two_term_presets().front())),
      std::make_shared<DrainePhase>(0.55f, 22.0f),
      std::make_shared<TabulatedPhase>(std::array{2.0f, 0.5f, 0.0f, 0.0f, 1.0f, 6.0f}),
      std::make_shared<FournierForandPhase>(FournierForandPhase::Parameters{1.10, 3.5835}),
      std::make_shared<MiePhase>(MiePhase::Parameters{.radius = 0.5, .deviation = 0.1})};
  for (size_t i = 0; i < phases.size(); ++i)
    EXPECT_NEAR(legendre_moments(*phases[i], 1)[1], static_cast<double>(phases[i]->mean_cosine()), 5e-4) << i;
}

TEST(PhaseMoments, DecayRates) {
  // Isotropic: albedo atanh(k) = k.
  for (const double albedo : {0.3, 0.5, 0.9, 0.99, 0.9995}) {
    const double k = decay_rate(std::vector<double>{1.0}, albedo);
    EXPECT_NEAR(albedo * std::atanh(k), k, 2e-3 * k) << albedo;
  }
  // Towards albedo 1: sqrt(3 (1 - albedo) (1 - g albedo)).
  const std::vector<double> f = legendre_moments(HenyeyGreensteinPhase(0.8f), 64);
  EXPECT_NEAR(decay_rate(f, 0.9999) / std::sqrt(3 * 1e-4 * (1 - 0.8 * 0.9999)), 1, 1e-3);
}

TEST(PhaseMoments, BandsAreChosenByThem) {
  EXPECT_EQ(choose_bands(IsotropicPhase()), (BandLimits{0, 0}));
  EXPECT_EQ(choose_bands(RayleighPhase()), (BandLimits{2, 1}));
  EXPECT_EQ(choose_bands(HenyeyGreensteinPhase(0.3f)), (BandLimits{3, 2}));
  EXPECT_EQ(choose_bands(HenyeyGreensteinPhase(-0.7f)), (BandLimits{10, 3}));
  EXPECT_EQ(choose_bands(HenyeyGreensteinPhase(0.9f)), (BandLimits{32, 6}));
  try {
    choose_bands(HenyeyGreensteinPhase(0.95f));
    FAIL() << "g = 0.95 was accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_EQ(std::string(error.what()),
              "this phase function's peak is too narrow for a table of multiple scattering: its Legendre moment 33 is "
              "0.184, at most 0.035 can be left out (Henyey-Greenstein: |g| <= 0.9). Use the method without a table, "
              "or a medium with reduced coefficients");
  }
}

}  // namespace
}  // namespace turbid
