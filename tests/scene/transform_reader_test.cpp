// Transforms of scene files against values worked out by hand.
#include "reading.h"

namespace turbid::testing {
namespace {

Transform transform_of(const std::string& operations) {
  return first_value<Transform>(
      read("<shape type=\"s\"><transform name=\"to_world\">" + operations + "</transform></shape>"), "to_world");
}

void expect_point(const Transform& transform, const Vec3& p, const Vec3& expected) {
  const Vec3 q = transform.point(p);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(q[i], expected[i], 1e-6f) << i;
}

TEST(TransformReader, OperationsApplyInTheOrderOfTheFile) {
  expect_point(transform_of("<scale value=\"2\"/><translate value=\"1, 0, 0\"/>"), {1, 1, 1}, {3, 2, 2});
  expect_point(transform_of("<translate value=\"1 0 0\"/><scale value=\"2\"/>"), {1, 1, 1}, {4, 2, 2});
}

TEST(TransformReader, LeftOutComponentsAreZeroOrOne) {
  expect_point(transform_of("<translate y=\"3\"/>"), {1, 1, 1}, {1, 4, 1});
  expect_point(transform_of("<scale z=\"3\"/>"), {1, 1, 1}, {1, 1, 3});
}

TEST(TransformReader, RotatesCounterClockwise) {
  expect_point(transform_of("<rotate z=\"1\" angle=\"90\"/>"), {1, 0, 0}, {0, 1, 0});
  expect_point(transform_of("<rotate value=\"1 1 1\" angle=\"120\"/>"), {1, 2, 3}, {3, 1, 2});
  expect_point(transform_of("<rotate x=\"5\" angle=\"-90\"/>"), {0, 1, 0}, {0, 0, -1});
}

TEST(TransformReader, ReadsMatricesRowByRow) {
  expect_point(transform_of("<matrix value=\"1 0 0 5  0 2 0 6  0 0 3 7  0 0 0 1\"/>"), {1, 1, 1}, {6, 8, 10});
  expect_point(transform_of("<matrix value=\"0,-1,0, 1,0,0, 0,0,1\"/>"), {1, 2, 3}, {-2, 1, 3});
}

TEST(TransformReader, LooksAlongPlusZWithLeftAsPlusX) {
  const Transform camera = transform_of("<lookat origin=\"1,2,3\" target=\"1,2,8\" up=\"0,1,0\"/>");
  expect_point(camera, {0, 0, 0}, {1, 2, 3});
  expect_point(camera, {0, 0, 1}, {1, 2, 4});
  expect_point(camera, {1, 0, 0}, {2, 2, 3});  // looking along +z with y up, left is +x
  const Transform side = transform_of("<lookat origin=\"0,0,0\" target=\"4,0,0\" up=\"0,0,1\"/>");
  expect_point(side, {0, 0, 1}, {1, 0, 0});
  expect_point(side, {0, 1, 0}, {0, 0, 1});
  expect_point(side, {1, 0, 0}, {0, 1, 0});
}

TEST(TransformReader, LookatWithoutUpChoosesOne) {
  const Transform camera = transform_of("<lookat origin=\"0,0,0\" target=\"0,5,0\"/>");
  expect_point(camera, {0, 0, 2}, {0, 2, 0});
  EXPECT_NEAR(camera.uniform_scale(), 1, 1e-6);
}

}  // namespace
}  // namespace turbid::testing
