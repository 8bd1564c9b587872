#include "render/progress.h"

#include <gtest/gtest.h>

namespace turbid {
namespace {

TEST(Progress, Durations) {
  EXPECT_EQ(format_duration(3.21), "3.2 s");
  EXPECT_EQ(format_duration(59.99), "1 min 00 s");
  EXPECT_EQ(format_duration(245), "4 min 05 s");
  EXPECT_EQ(format_duration(2 * 3600 + 7 * 60 + 12), "2 h 07 min");
}

TEST(Progress, BySamples) {
  const ProgressState state{.samples = 24, .target = 64, .elapsed = 12, .pixels = 1e6};
  EXPECT_DOUBLE_EQ(*state.fraction(), 0.375);
  EXPECT_DOUBLE_EQ(*state.remaining(), 20);
  EXPECT_EQ(describe(state), "37 %, 24 of 64 samples per pixel, 12.0 s, 20.0 s left, 2.00 million samples/s");
}

TEST(Progress, AResumedRenderIsJudgedByItsOwnSpeed) {
  const ProgressState state{.samples = 24, .target = 64, .elapsed = 12, .samples_before = 20, .pixels = 1e6};
  EXPECT_DOUBLE_EQ(*state.remaining(), 120);
}

TEST(Progress, ByTimeAndWithoutEnd) {
  EXPECT_EQ(describe({.samples = 24, .seconds = 60, .elapsed = 15, .pixels = 1}),
            "25 %, 24 samples per pixel, 15.0 s, 45.0 s left, 0.00 million samples/s");
  EXPECT_EQ(describe({.samples = 0, .elapsed = 15, .pixels = 1}), "0 samples per pixel, 15.0 s");
}

}  // namespace
}  // namespace turbid
