// The fit of Jendersie & d'Eon 2023 to Mie scattering: its own numbers, and itself against Mie.
#include "medium/mie_fit.h"

#include <gtest/gtest.h>

#include <numbers>

#include "core/vector.h"
#include "medium/mie.h"
#include "medium/phases_for_tests.h"

namespace turbid {
namespace {

constexpr double kPiD = std::numbers::pi;

TEST(MieFit, HasTheParametersOfThePaper) {
  // By hand from the formulas for 5 um <= d <= 50 um.
  const MieFitPhase::Parameters p = MieFitPhase::parameters(10);
  EXPECT_NEAR(p.g_hg, 0.988177f, 1e-5f);
  EXPECT_NEAR(p.g_draine, 0.555671f, 1e-5f);
  EXPECT_NEAR(p.alpha, 21.9954f, 1e-3f);
  EXPECT_NEAR(p.w_draine, 0.481955f, 1e-5f);
}

TEST(MieFit, HoldsForEveryDiameterItAccepts) {
  float last = MieFitPhase(0.001f).mean_cosine();
  for (float d = 0.001f; d < 50; d *= 1.002f) {
    const float g = MieFitPhase(d).mean_cosine();  // throws when a parameter is out of range
    // Between the ranges of the fit its mean cosine jumps by 0.013 at 0.1 um and by 0.002 and less above.
    ASSERT_NEAR(g, last, 0.015f) << d;
    last = g;
  }
  for (const float d : {0.0f, -1.0f, 50.1f, std::numeric_limits<float>::quiet_NaN()})
    EXPECT_THROW(MieFitPhase{d}, std::invalid_argument) << d;
}

/// The part of the light that is deflected by at most this many degrees.
double within(const PhaseFunction& phase, double degrees) {
  return testing::integrate_interval(
      [&](double theta) {
        return 2 * kPiD * std::sin(theta) * static_cast<double>(phase.eval_angle(static_cast<float>(theta)));
      },
      0, degrees * kPiD / 180, 1e-7, 6, 12);
}

TEST(MieFit, ResemblesMieForDropletsOfTenMicrometres) {
  // The fit leaves out rings, rainbow (138 degrees) and glory (180), and has a sharper tip in the innermost degrees.
  const MieFitPhase fit(10);
  const MiePhase mie({.radius = 5, .deviation = 0.2});
  std::string table;
  for (const int degrees : {0, 1, 2, 5, 10, 15, 20, 30, 45, 60, 90, 120, 138, 150, 160, 170, 180}) {
    const float theta = static_cast<float>(degrees) * kPi / 180;
    table += std::to_string(degrees) + ": mie " + std::to_string(mie.eval_angle(theta)) + ", fit " +
             std::to_string(fit.eval_angle(theta)) + " 1/sr\n";
  }
  for (const int degrees : {5, 10, 15, 20, 30, 45, 60, 150, 160, 170}) {
    const float theta = static_cast<float>(degrees) * kPi / 180;
    EXPECT_NEAR(fit.eval_angle(theta) / mie.eval_angle(theta), 1, 0.1f) << degrees << "\n" << table;
  }
  for (const int degrees : {0, 1, 2, 3, 75, 90, 105, 120, 130, 138, 142, 175, 180}) {
    const float theta = static_cast<float>(degrees) * kPi / 180;
    const float ratio = fit.eval_angle(theta) / mie.eval_angle(theta);
    EXPECT_TRUE(ratio > 0.2f && ratio < 4) << degrees << "\n" << table;
  }
  for (const double degrees : {2.0, 5.0, 15.0, 30.0, 60.0, 90.0, 140.0})
    EXPECT_NEAR(within(fit, degrees), within(mie, degrees), 0.05) << degrees << "\n" << table;
  EXPECT_NEAR(fit.mean_cosine(), mie.mean_cosine(), 0.02f);
  ::testing::Test::RecordProperty("eval", table);
}

TEST(MieFit, HasNearlyTheMeanCosineOfMie) {
  // Below a micrometre the fit is looser.
  for (const auto& [diameter, tolerance] :
       {std::pair{0.08f, 0.05f}, {0.3f, 0.05f}, {1.0f, 0.02f}, {3.0f, 0.02f}, {5.0f, 0.02f}, {20.0f, 0.02f}}) {
    const MiePhase mie({.radius = static_cast<double>(diameter) / 2, .deviation = 0.2});
    EXPECT_NEAR(MieFitPhase(diameter).mean_cosine(), mie.mean_cosine(), tolerance) << diameter;
  }
}

}  // namespace
}  // namespace turbid
