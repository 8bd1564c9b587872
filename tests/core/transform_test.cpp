#include "core/transform.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "core/frame.h"
#include "core/rng.h"
#include "core/warp.h"

namespace turbid {
namespace {

void expect_near(const Vec3& a, const Vec3& b, float tolerance = 1e-5f) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
  EXPECT_NEAR(a.z, b.z, tolerance);
}

TEST(Transform, ProductsApplyTheRightOneFirst) {
  const Transform t = Transform::translate(1, 2, 3) * Transform::scale(2, 2, 2);
  expect_near(t.point({1, 1, 1}), {3, 4, 5});
  expect_near(t.vector({1, 1, 1}), {2, 2, 2});
  expect_near(t.inverse().point({3, 4, 5}), {1, 1, 1});
}

TEST(Transform, RotationIsCounterClockwise) {
  expect_near(Transform::rotate(0, 0, 1, 90).vector({1, 0, 0}), {0, 1, 0});
  expect_near(Transform::rotate(1, 0, 0, 90).vector({0, 1, 0}), {0, 0, 1});
  expect_near(Transform::rotate(0, 2, 0, 90).vector({0, 0, 1}), {1, 0, 0});
}

TEST(Transform, NormalsStayPerpendicularUnderNonUniformScale) {
  const Transform t = Transform::rotate(1, 2, 3, 40) * Transform::scale(1, 3, 0.2);
  const Vec3 tangent{1, 1, 1}, normal{1, -2, 1};
  EXPECT_NEAR(dot(t.vector(tangent), t.normal(normal)), 0, 1e-4);
}

TEST(Transform, LookAtPutsTheTargetOnPositiveZ) {
  const Transform t = Transform::look_at({1, 2, 3}, {4, 2, 3}, {0, 1, 0});
  expect_near(t.vector({0, 0, 1}), {1, 0, 0});
  expect_near(t.vector({0, 1, 0}), {0, 1, 0});
  expect_near(t.point({0, 0, 0}), {1, 2, 3});
  EXPECT_FALSE(t.flips_handedness());
}

TEST(Transform, RefusesWhatHasNoMeaning) {
  EXPECT_THROW(Transform::scale(1, 0, 1), std::invalid_argument);
  EXPECT_THROW(Transform::rotate(0, 0, 0, 10), std::invalid_argument);
  EXPECT_THROW(Transform::look_at({1, 1, 1}, {1, 1, 1}, {0, 1, 0}), std::invalid_argument);
  EXPECT_THROW(Transform::look_at({0, 0, 0}, {0, 1, 0}, {0, 2, 0}), std::invalid_argument);
}

TEST(Transform, KnowsSimilaritiesAndMirrors) {
  EXPECT_NEAR((Transform::rotate(1, 1, 0, 33) * Transform::scale(3, 3, 3)).uniform_scale(), 3, 1e-9);
  EXPECT_EQ(Transform::scale(1, 2, 1).uniform_scale(), 0);
  EXPECT_TRUE(Transform::scale(-1, 1, 1).flips_handedness());
}

TEST(Frame, IsOrthonormalForEveryNormal) {
  Rng rng(3);
  for (int i = 0; i < 1000; ++i) {
    Vec3 n = square_to_sphere({rng.next_float(), rng.next_float()});
    if (i == 0) n = {0, 0, 1};
    if (i == 1) n = {0, 0, -1};
    const Frame frame(n);
    expect_near(cross(frame.s, frame.t), n, 1e-6f);
    EXPECT_NEAR(length(frame.s), 1, 1e-6);
    EXPECT_NEAR(dot(frame.s, frame.t), 0, 1e-6);
    expect_near(frame.to_world(frame.to_local({1, 2, 3})), {1, 2, 3}, 1e-5f);
  }
}

TEST(Frame, DirectionAboutHasTheAngleAskedFor) {
  for (const float mu : {-1.0f, -0.3f, 0.0f, 0.9f, 1.0f}) {
    const Vec3 n = normalize(Vec3(1, -2, 0.5f));
    const Vec3 w = direction_about(n, mu, 1.1f);
    EXPECT_NEAR(dot(w, n), mu, 1e-6);
    EXPECT_NEAR(length(w), 1, 1e-6);
  }
}

}  // namespace
}  // namespace turbid
