// Fournier-Forand: the formula against its integral and published numbers, the table against the formula.
#include "medium/fournier_forand.h"

#include <gtest/gtest.h>

#include <numbers>

#include "medium/phases_for_tests.h"

namespace turbid {
namespace {

using Parameters = FournierForandPhase::Parameters;
constexpr double kPiD = std::numbers::pi;

const std::vector<Parameters> kPairs{{1.021, 3.0742}, {1.04, 3.201}, {1.08, 3.483}, {1.1, 3.5835},
                                     {1.175, 4.065},  {1.15, 4.874}, {1.3, 3.01},   {1.001, 4.99}};

TEST(FournierForand, IsTheDerivativeOfItsIntegral) {
  for (const Parameters& p : kPairs) {
    EXPECT_NEAR(FournierForandPhase::cumulative(p, kPiD), 1, 1e-12);
    // delta is 1, where terms cancel, at s = sqrt(3) (n - 1) / 2.
    const double cancelling = 2 * std::asin(std::sqrt(3) * (p.n - 1) / 2);
    for (const double theta : {1e-4, 0.01, 0.2, cancelling, cancelling * 1.0001, cancelling * 1.02, cancelling * 1.03,
                               cancelling * 0.97, 1.5, 3.0}) {
      const double h = 1e-4 * theta;
      const auto f = [&](double t) { return FournierForandPhase::cumulative(p, t); };
      // Fourth order in h.
      const double slope = (8 * (f(theta + h) - f(theta - h)) - (f(theta + 2 * h) - f(theta - 2 * h))) / (12 * h);
      const double expected = 2 * kPiD * std::sin(theta) * FournierForandPhase::density(p, theta);
      EXPECT_NEAR(slope / expected, 1, 1e-5) << p.n << ' ' << p.slope << " at " << theta;
    }
  }
}

TEST(FournierForand, ScattersBackWhatMobleyTabulates) {
  // Mobley et al. 2002: index, slope, backscattered part; given with few digits.
  const auto backward = [](const Parameters& p) { return 1 - FournierForandPhase::cumulative(p, kPiD / 2); };
  EXPECT_NEAR(backward({1.021, 3.0742}), 0.0001, 5e-6);
  EXPECT_NEAR(backward({1.04, 3.201}), 0.001, 2e-5);
  EXPECT_NEAR(backward({1.08, 3.483}), 0.01, 1e-4);
  EXPECT_NEAR(backward({1.1, 3.5835}), 0.0183, 1e-4);  // Petzold's average particle
  EXPECT_NEAR(backward({1.175, 4.065}), 0.1, 5e-4);
  EXPECT_NEAR(backward({1.15, 4.874}), 0.4, 1e-3);
}

TEST(FournierForand, IsFoundByItsBackscatter) {
  for (const double ratio : {1e-4, 1e-3, 0.0183, 0.1}) {
    const Parameters p = FournierForandPhase::from_backscatter(ratio);
    EXPECT_NEAR((1 - FournierForandPhase::cumulative(p, kPiD / 2)) / ratio, 1, 1e-9);
  }
  const Parameters average = FournierForandPhase::from_backscatter(0.0183);
  EXPECT_NEAR(average.n, 1.1, 1e-3);
  EXPECT_NEAR(average.slope, 3.5835, 1e-3);
  for (const double ratio : {0.0, 5e-5, 0.11, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_THROW(FournierForandPhase::from_backscatter(ratio), std::invalid_argument) << ratio;
}

TEST(FournierForand, TableMeetsTheFormula) {
  for (const Parameters& p : kPairs) {
    const FournierForandPhase phase(p);
    EXPECT_NEAR(phase.table().integral(), 1, 2e-4);
    for (double theta = 5e-4; theta < kPiD; theta *= 1.037) {
      const auto seen = static_cast<double>(phase.eval_angle(static_cast<float>(theta)));
      EXPECT_NEAR(seen / FournierForandPhase::density(p, theta), 1, 5e-4) << p.n << ' ' << p.slope << " at " << theta;
    }
    // The innermost cone has what the pole has.
    const double rim = 2 * std::asin(std::sqrt(0x1p-24));
    const double inside =
        testing::integrate_angles(phase, [&](double theta) { return theta < rim ? 2 * kPiD * std::sin(theta) : 0; });
    EXPECT_NEAR(inside, FournierForandPhase::cumulative(p, rim), 1e-3);
  }
}

TEST(FournierForand, PlantedErrorsAreFound) {
  const FournierForandPhase right({1.1, 3.5835});
  EXPECT_FALSE(passes(testing::test_samples(right, FournierForandPhase({1.11, 3.5835})), 100));
  EXPECT_FALSE(passes(testing::test_samples(right, FournierForandPhase({1.1, 3.65})), 100));
}

TEST(FournierForand, RefusesImpossibleParticles) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Parameters& p : {Parameters{1, 3.5}, Parameters{0.9, 3.5}, Parameters{1.4, 3.5}, Parameters{1.1, 3},
                              Parameters{1.1, 5}, Parameters{nan, 3.5}, Parameters{1.1, nan}})
    EXPECT_THROW(FournierForandPhase{p}, std::invalid_argument) << p.n << ' ' << p.slope;
}

}  // namespace
}  // namespace turbid
