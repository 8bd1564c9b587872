#include "scene/medium_stack.h"

#include "medium/homogeneous.h"
#include "medium/isotropic.h"
#include "reading.h"

namespace turbid::testing {
namespace {

/// Objects 0, 1, 2 ... of these priorities, each with a medium of its own.
std::vector<Object> objects_of(const std::vector<int>& priorities) {
  std::vector<Object> objects(priorities.size());
  for (size_t i = 0; i < objects.size(); ++i) {
    objects[i].interior =
        std::make_shared<HomogeneousMedium>(Spectrum(1.0f), Spectrum(0.5f), std::make_shared<IsotropicPhase>());
    objects[i].priority = priorities[i];
    objects[i].encloses = true;
  }
  return objects;
}

TEST(MediumStack, KnowsTheHighestInWhicheverOrderTheyAreEntered) {
  const std::vector<Object> objects = objects_of({2, 5, 2});
  std::vector<size_t> order = {0, 1, 2};
  do {
    MediumStack stack;
    for (const size_t i : order) stack.enter(objects[i]);
    EXPECT_EQ(stack.medium(), objects[1].interior.get());
    EXPECT_TRUE(stack.hides(objects[0]));
    EXPECT_FALSE(stack.hides(objects[1]));
    stack.leave(objects[1]);
    EXPECT_EQ(stack.medium(), objects[2].interior.get());  // later in the file
    stack.leave(objects[2]);
    stack.leave(objects[2]);  // again: changes nothing
    EXPECT_EQ(stack.medium(), objects[0].interior.get());
    stack.leave(objects[0]);
    EXPECT_EQ(stack.medium(), nullptr);
  } while (std::next_permutation(order.begin(), order.end()));
}

TEST(MediumStack, CountsShapesThatOverlapThemselves) {
  const std::vector<Object> objects = objects_of({0});
  MediumStack stack;
  stack.enter(objects[0]);
  stack.enter(objects[0]);
  stack.leave(objects[0]);
  EXPECT_EQ(stack.medium(), objects[0].interior.get());
  stack.leave(objects[0]);
  EXPECT_EQ(stack.medium(), nullptr);
}

TEST(MediumStack, ForgetsTheLowestOfVeryMany) {
  const std::vector<Object> objects = objects_of(std::vector<int>(40, 0));
  MediumStack stack;
  for (const Object& object : objects) stack.enter(object);
  for (size_t i = objects.size(); i-- > 30;) {
    EXPECT_EQ(stack.medium(), objects[i].interior.get());
    stack.leave(objects[i]);
  }
}

TEST(MediumStack, StaysOnItsSideInReflection) {
  const std::vector<Object> objects = objects_of({0});
  MediumStack stack;
  const Vec3 up(0, 0, 1), slanted(1, 0, 1), down(0, 0, -1);
  stack.cross(objects[0], up, slanted, up);
  EXPECT_EQ(stack.medium(), nullptr);
  stack.cross(objects[0], up, slanted, down);
  EXPECT_EQ(stack.medium(), objects[0].interior.get());
  stack.cross(objects[0], up, down, up);
  EXPECT_EQ(stack.medium(), nullptr);
}

TEST(World, IsOne) {
  EXPECT_EQ(
      load_complaint("<medium type=\"homogeneous\" name=\"world\"/>\n<medium type=\"homogeneous\" name=\"world\"/>"),
      "3 test.xml:3:1: a scene can have one medium named 'world'");
}

TEST(Priority, IsAnInteger) {
  EXPECT_EQ(load_complaint("<shape type=\"cube\"><float name=\"priority\" value=\"1.5\"/></shape>"),
            "3 test.xml:2:50: 'priority' of shape 'cube' expects an integer, found a float");
}

}  // namespace
}  // namespace turbid::testing
