// The ratio of what leaves media to what is predicted to.
#include "integrator/light_balance.h"

#include <gtest/gtest.h>

#include <functional>
#include <map>

#include "core/frame.h"
#include "core/rng.h"

namespace turbid::testing {
namespace {

/// Light from places in the unit cube, one after the other.
std::vector<LeavingPower> light_of(size_t count, uint64_t seed,
                                   const std::function<float(const LeavingPower&)>& power) {
  Rng rng(seed);
  std::vector<LeavingPower> all;
  for (size_t i = 0; i < count; ++i) {
    LeavingPower one;
    one.scattered = {rng.next_float(), rng.next_float(), rng.next_float()};
    one.direction = direction_about({0, 0, 1}, 1 - 2 * rng.next_float(), 2 * kPi * rng.next_float());
    one.power = Spectrum(1, 2, 0.5f) * (power(one) / static_cast<float>(count));
    all.push_back(one);
  }
  return all;
}

// What is predicted, times the ratio, is what leaves each part in about each direction.
TEST(LightBalance, MakesThePredictionWhatLeaves) {
  const auto truth = [](const LeavingPower& l) { return 0.5f + l.scattered.x + 0.4f * l.direction.z; };
  const auto one = [](const LeavingPower&) { return 1.0f; };
  const LightBalance balance(light_of(400'000, 1, truth), light_of(300'000, 2, one), 512);
  std::map<std::array<bool, 2>, std::array<double, 3>> parts;
  for (const LeavingPower& l : light_of(50'000, 3, truth)) {
    auto& [leaves, predicted, as_all] = parts[{l.scattered.x > 0.5f, l.direction.z > 0}];
    leaves += static_cast<double>(l.power[1]);
    predicted += static_cast<double>(l.power[1] / truth(l) * balance.at(l.scattered, l.direction)[1]);
    as_all += static_cast<double>(l.power[1] / truth(l));  // which is 1 in the mean
  }
  ASSERT_EQ(parts.size(), 4u);
  double worst = 0;
  for (const auto& [part, sums] : parts) {
    EXPECT_NEAR(sums[1] / sums[0], 1, 0.12);
    worst = std::max(worst, std::abs(sums[2] / sums[0] - 1));
  }
  EXPECT_GT(worst, 0.3) << "the ratio of all would do";
}

// With few samples there is the ratio of all, not the noise of one place; without any nothing changes.
TEST(LightBalance, FallsBackOnLargerParts) {
  const auto one = [](const LeavingPower&) { return 1.0f; };
  const auto three = [](const LeavingPower&) { return 3.0f; };
  const LightBalance few(light_of(40, 1, three), light_of(60, 2, one), 1000);
  for (const LeavingPower& l : light_of(50, 3, one)) {
    const float ratio = few.at(l.scattered, l.direction)[2];
    EXPECT_GT(ratio, 2);
    EXPECT_LT(ratio, 4.5f);
  }
  EXPECT_EQ(LightBalance().at({1, 2, 3}, {0, 0, 1}), Spectrum(1.0f));
  EXPECT_EQ(LightBalance({}, light_of(10, 1, one), 8).at({1, 2, 3}, {0, 0, 1}), Spectrum(1.0f));
  const std::vector<LeavingPower> all = light_of(100, 1, one);
  EXPECT_EQ(LightBalance(all, {}, 8).at(all[0].scattered, {0, 0, 1}), Spectrum(1.0f));
  const std::vector<LeavingPower> at_one_place(10, all[0]);
  EXPECT_EQ(LightBalance(at_one_place, all, 8).at({0, 0, 0}, {0, 0, 1}), Spectrum(1.0f));
}

}  // namespace
}  // namespace turbid::testing
