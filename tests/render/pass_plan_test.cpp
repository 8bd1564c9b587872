#include "render/pass_plan.h"

#include <gtest/gtest.h>

namespace turbid {
namespace {

TEST(PassPlan, SizeOfAPassDependsOnTheImageAlone) {
  EXPECT_EQ(samples_per_pass({1, 1}), 64u);
  EXPECT_EQ(samples_per_pass({100, 80}), 64u);
  EXPECT_EQ(samples_per_pass({256, 256}), 8u);
  EXPECT_EQ(samples_per_pass({768, 576}), 2u);
  EXPECT_EQ(samples_per_pass({1920, 1080}), 1u);
  EXPECT_EQ(samples_per_pass({30000, 30000}), 1u);
}

TEST(PassPlan, EndsExactlyAtTheSamplesAskedFor) {
  const PassPlan plan({256, 256}, {.samples = 20}, 5);
  EXPECT_EQ(plan.target(), 20u);
  for (const uint64_t first : {0u, 8u, 16u}) {
    const auto pass = plan.next(first);
    ASSERT_TRUE(pass);
    EXPECT_EQ(pass->seed, 5u);
    EXPECT_EQ(pass->first_sample, first);
    EXPECT_EQ(pass->sample_count, first == 16 ? 4u : 8u);
  }
  EXPECT_FALSE(plan.next(20));
  EXPECT_FALSE(plan.next(24));
}

TEST(PassPlan, CanGrow) {
  const PassPlan plan = PassPlan::growing({.samples = 5000}, 3);
  uint64_t samples = 0, largest = 0;
  while (const auto pass = plan.next(samples)) {
    EXPECT_EQ(pass->first_sample, samples);
    EXPECT_TRUE(pass->sample_count == 1 || pass->sample_count * 32 <= samples) << samples;
    EXPECT_TRUE(samples % pass->sample_count == 0 || samples + pass->sample_count == 5000) << samples;
    largest = std::max<uint64_t>(largest, pass->sample_count);
    samples += pass->sample_count;
  }
  EXPECT_EQ(samples, 5000u);
  EXPECT_EQ(largest, 64u);
}

TEST(PassPlan, PassesAndNoEnd) {
  EXPECT_EQ(PassPlan({256, 256}, {.passes = 3}, 0).target(), 24u);
  const PassPlan endless({256, 256}, {.seconds = 3}, 0);
  EXPECT_FALSE(endless.target());
  EXPECT_EQ(endless.next(8000)->sample_count, 8u);
}

}  // namespace
}  // namespace turbid
