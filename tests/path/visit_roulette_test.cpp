// Which walks from lights go on after they have scattered often.
#include "path/visit_roulette.h"

#include <gtest/gtest.h>

#include "medium/homogeneous.h"
#include "medium/isotropic.h"

namespace turbid::testing {
namespace {

/// What walks of a number of visits, each of `collisions` collisions, weigh on average, and at most, where they go on.
std::pair<double, double> weight_of(int visits, int collisions, bool in_listed_medium = true) {
  const HomogeneousMedium medium(Spectrum(1.0f), Spectrum(0.9f), std::make_shared<IsotropicPhase>()), other = medium;
  VisitRoulette roulette({&medium});
  constexpr int kWalks = 40'000;
  double sum = 0, largest = 0;
  for (int walk = 0; walk < kWalks; ++walk) {
    roulette.begin(Rng(hash_counters(uint64_t{5}, static_cast<uint64_t>(walk))));
    for (int visit = 0; visit < visits && roulette.goes_on(); ++visit)
      for (int k = 1; k <= collisions && roulette.goes_on(); ++k)
        roulette.left_collision(in_listed_medium ? medium : other, {Spectrum(1.0f), 0, k, k});
    if (!roulette.goes_on()) continue;
    const auto scale = static_cast<double>(roulette.scale());
    sum += scale;
    largest = std::max(largest, scale);
  }
  return {sum / kWalks, largest};
}

TEST(VisitRoulette, KeepsTheMeanAndAsksOnce) {
  for (const int visits : {1, 2, 7}) {
    const auto [mean, largest] = weight_of(visits, 9);
    EXPECT_NEAR(mean, 1, 0.06) << visits << " visits";
    EXPECT_FLOAT_EQ(static_cast<float>(largest), 1 / VisitRoulette::kShare) << visits << " visits";
  }
  EXPECT_EQ(weight_of(5, VisitRoulette::kOften - 1), (std::pair{1.0, 1.0})) << "not often enough";
  EXPECT_EQ(weight_of(2, 9, false), (std::pair{1.0, 1.0})) << "another medium";
}

}  // namespace
}  // namespace turbid::testing
