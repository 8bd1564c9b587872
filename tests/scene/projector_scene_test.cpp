// Projectors in scene files.
#include "reading.h"

namespace turbid::testing {
namespace {

TEST(Projectors, TakeTheirShapeFromThePicture) {
  const LoadedScene scene = load_scene_from_string(
      scene_of("<emitter type=\"projector\"><float name=\"irradiance\" value=\"1\"/><float name=\"scale\" "
               "value=\"3\"/><float name=\"fov\" value=\"90\"/></emitter>"),
      "test.xml");
  // A picture of no size is square: 2 x 2 at distance 1.
  EXPECT_NEAR(scene.parts.emitters.at(0)->power()[0], kPi * 3 * 4, 1e-4f);
}

struct Malformed {
  std::string content, expected;
};

TEST(Projectors, RefuseWhatMakesNoSense) {
  const std::vector<Malformed> cases = {
      {"<emitter type=\"projector\"/>",
       "3 test.xml:2:1: emitter 'projector' needs the parameter 'irradiance' (a texture: the picture: over pi, W/m^2 "
       "on "
       "a plane across the axis at distance 1)"},
      {"<emitter type=\"projector\"><float name=\"irradiance\" value=\"1\"/><float name=\"fov\" "
       "value=\"180\"/></emitter>",
       "3 test.xml:2:88: 'fov' of emitter 'projector' is 180, expected a number in (0, 180)"},
      {"<emitter type=\"projector\"><float name=\"irradiance\" value=\"1\"/><transform name=\"to_world\"><scale "
       "value=\"2\"/></transform></emitter>",
       "3 test.xml:2:1: emitter 'projector': the to_world transform of a projector must not scale or shear"}};
  for (const Malformed& malformed : cases) EXPECT_EQ(load_complaint(malformed.content), malformed.expected);
}

}  // namespace
}  // namespace turbid::testing
