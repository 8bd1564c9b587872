#include "table/lanes.h"

#include <gtest/gtest.h>

#include "core/frame.h"
#include "core/rng.h"
#include "core/warp.h"
#include "table/polar_grid.h"
#include "table/sagittal_view.h"

namespace turbid {
namespace {

/// Eight directions, and the same side by side.
struct Directions {
  std::array<Vec3, kLanes> each;
  Vec3Lanes lanes;
  explicit Directions(Rng& rng) {
    std::array<LaneRow, 3> rows;
    for (size_t i = 0; i < kLanes; ++i) {
      const float u = rng.next_float();
      each[i] = square_to_sphere({u, rng.next_float()});
      for (size_t axis = 0; axis < 3; ++axis) rows[axis][i] = each[i][static_cast<int>(axis)];
    }
    lanes = {load_lanes(rows[0]), load_lanes(rows[1]), load_lanes(rows[2])};
  }
};

float difference(const Vec3Lanes& lanes, size_t lane, const Vec3& v) {
  return length(Vec3(lanes.x[lane], lanes.y[lane], lanes.z[lane]) - v);
}

TEST(Lanes, LogarithmsAreThoseOfTheLibrary) {
  for (float x = 1e-30f; x < 1e30f; x *= 1.37f)
    for (const float at : {x, 1 + x * 1e-7f, 1 - 0x1p-24f, 1.0f}) {
      const double expected = std::log(static_cast<double>(at));
      const double error = std::abs(static_cast<double>(log_lanes(Lanes(at))[3]) - expected);
      EXPECT_LE(error, 2e-7 * std::max(std::abs(expected), at > 0.7f && at < 1.4f ? 0.0 : 0.7)) << at;
    }
}

TEST(Lanes, ExponentialsAreThoseOfTheLibrary) {
  for (float x = -86.9f; x < 87; x += 0.0137f) {
    const double expected = std::exp(static_cast<double>(x));
    EXPECT_NEAR(static_cast<double>(exp_lanes(Lanes(x))[6]) / expected, 1, 2.5e-7) << x;
  }
  EXPECT_EQ(exp_lanes(Lanes(0.0f))[0], 1);
  EXPECT_EQ(exp_lanes(Lanes(-1e5f))[0], 0);
  EXPECT_EQ(exp_lanes(Lanes(-kInfinity))[0], 0);
}

TEST(Lanes, TurnsAreCosineAndSine) {
  for (int i = 0; i <= 4096; ++i) {
    const float u = static_cast<float>(i) / 4096;
    const TurnLanes turn{Lanes(u)};
    const double phi = 2 * std::numbers::pi * static_cast<double>(u);
    EXPECT_NEAR(static_cast<double>(turn.cosine[5]), std::cos(phi), 3e-7) << u;
    EXPECT_NEAR(static_cast<double>(turn.sine[5]), std::sin(phi), 3e-7) << u;
  }
}

TEST(Lanes, FramesAndViewsAreThoseOfEachLane) {
  Rng rng(2);
  const PolarGrid grid(48, 28, 250);
  for (int n = 0; n < 500; ++n) {
    const Directions normal(rng), v(rng), axis(rng);
    const FrameLanes frames(normal.lanes);
    const Vec3Lanes local = frames.to_local(v.lanes), world = frames.to_world(v.lanes);
    const Vec3Lanes x = normal.lanes * Lanes(2.5f);
    const SagittalViewLanes views(x, axis.lanes, v.lanes);
    for (size_t i = 0; i < kLanes; ++i) {
      const Frame frame(normal.each[i]);
      EXPECT_LT(difference(local, i, frame.to_local(v.each[i])), 2e-6f);
      EXPECT_LT(difference(world, i, frame.to_world(v.each[i])), 2e-6f);
      const SagittalView view(normal.each[i] * 2.5f, axis.each[i], v.each[i]);
      EXPECT_NEAR(views.distance[i], view.distance, 1e-5f);
      EXPECT_NEAR(views.cosine[i], view.cosine, 1e-6f);
      EXPECT_LT(difference(views.direction, i, view.direction), 1e-3f);
      EXPECT_NEAR(grid.radial(views.distance)[i], grid.radial(view.distance), 1e-4f);
      EXPECT_NEAR(grid.angular(views.cosine)[i], grid.angular(view.cosine), 1e-4f);
    }
  }
}

TEST(Lanes, ViewsFromTheSourceAndFromItsAxisHaveNoSide) {
  for (const float distance : {0.0f, 3.0f}) {
    const Vec3 axis(0, 0, 1), w = normalize(Vec3(0.6f, 0.3f, 0.5f));
    const SagittalView view(axis * distance, axis, w);
    const SagittalViewLanes views(lanes_of(axis * distance), lanes_of(axis), lanes_of(w));
    EXPECT_EQ(view.cosine, 1);
    EXPECT_EQ(view.direction.x, 0);
    EXPECT_NEAR(view.direction.z, w.z, 1e-6f);
    EXPECT_NEAR(length(view.direction), 1, 1e-6f);
    EXPECT_LT(difference(views.direction, 1, view.direction), 1e-6f);
  }
}

}  // namespace
}  // namespace turbid
