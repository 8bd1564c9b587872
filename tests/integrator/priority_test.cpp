// Nested and overlapping media with priorities, and the medium around everything, against closed forms: what only
// absorbs multiplies the light behind it by exp(-sigma x length), so every picture is known without noise.
#include <gtest/gtest.h>

#include "integrator/rendering.h"

namespace turbid::testing {
namespace {

std::string medium(const std::string& name, float sigma, const std::string& more = "") {
  return "<medium name=\"" + name + "\" type=\"homogeneous\"><float name=\"sigma_t\" value=\"" + std::to_string(sigma) +
         "\"/><float name=\"albedo\" value=\"0\"/>" + more + "</medium>";
}
std::string priority(int n) { return "<integer name=\"priority\" value=\"" + std::to_string(n) + "\"/>"; }

std::string ball(float x, float radius, const std::string& content, const std::string& bsdf = "null") {
  return "<shape type=\"sphere\"><point name=\"center\" value=\"" + std::to_string(x) +
         ", 0, 0\"/><float name=\"radius\" value=\"" + std::to_string(radius) + "\"/><bsdf type=\"" + bsdf + "\"/>" +
         content + "</shape>";
}

/// The optical depth of the scene along the x axis, from x = -10 (or `eye`) on, as seen against a sky of radiance 1.
double depth_along_x(const std::string& content, float eye = -10) {
  const std::string scene = R"(<scene version="3.0.0"><integrator type="volpath"/>
    <sensor type="perspective"><float name="fov" value="0.001"/><float name="near_clip" value="0"/>
      <transform name="to_world"><lookat origin=")" +
                            std::to_string(eye) + R"(,0,0" target="100,0,0" up="0,1,0"/></transform>
      <film type="hdrfilm"><integer name="width" value="1"/><integer name="height" value="1"/></film></sensor>
    <emitter type="constant"><rgb name="radiance" value="1"/></emitter>)" +
                            content + "</scene>";
  const Film film = render_text(scene, 4);
  return -std::log(film.pixel(0).radiance[0] / static_cast<double>(film.samples()));
}

constexpr double kRounding = 2e-5;

// Balls on [-1.5, 0.5] and [-0.5, 1.5]: they overlap for a length of 1.
TEST(Priority, TheHigherOneFillsTheOverlapWhicheverStandsFirst) {
  const std::string a = medium("interior", 0.3f, priority(2)), b = medium("interior", 1.1f, priority(1));
  EXPECT_NEAR(depth_along_x(ball(-0.5f, 1, a) + ball(0.5f, 1, b)), 2 * 0.3 + 1 * 1.1, kRounding);
  EXPECT_NEAR(depth_along_x(ball(0.5f, 1, b) + ball(-0.5f, 1, a)), 2 * 0.3 + 1 * 1.1, kRounding);
  EXPECT_NEAR(depth_along_x(ball(-0.5f, 1, b) + ball(0.5f, 1, a)), 1 * 1.1 + 2 * 0.3, kRounding);
}

TEST(Priority, AmongEqualsTheLaterInTheFile) {
  const std::string a = medium("interior", 0.3f, priority(1)), b = medium("interior", 1.1f, priority(1));
  EXPECT_NEAR(depth_along_x(ball(-0.5f, 1, a) + ball(0.5f, 1, b)), 1 * 0.3 + 2 * 1.1, kRounding);
  EXPECT_NEAR(depth_along_x(ball(0.5f, 1, b) + ball(-0.5f, 1, a)), 2 * 0.3 + 1 * 1.1, kRounding);
}

TEST(Priority, OfTheShapeWinsOverThatOfTheMedium) {
  const std::string a = medium("interior", 0.3f, priority(1)), b = medium("interior", 1.1f, priority(2));
  EXPECT_NEAR(depth_along_x(ball(-0.5f, 1, a + priority(3)) + ball(0.5f, 1, b)), 2 * 0.3 + 1 * 1.1, kRounding);
}

TEST(Priority, NestedBallsNeedNoExterior) {
  const std::string inner = medium("interior", 2, priority(1)), outer = medium("interior", 0.5f);
  EXPECT_NEAR(depth_along_x(ball(0, 2, outer) + ball(0, 1, inner)), 2 * 0.5 + 2 * 2, kRounding);
  EXPECT_NEAR(depth_along_x(ball(0, 1, inner) + ball(0, 2, outer)), 2 * 0.5 + 2 * 2, kRounding);
}

TEST(Priority, WithoutAnyMitsubasRuleHolds) {
  // Leaving the inner ball, whose outside is not declared, leads into vacuum; the far side of the outer one then
  // only leads out.
  const std::string inner = medium("interior", 2), outer = medium("interior", 0.5f);
  EXPECT_NEAR(depth_along_x(ball(0, 2, outer) + ball(0, 1, inner)), 1 * 0.5 + 2 * 2, kRounding);
}

TEST(Priority, AnEmptyBubble) {
  EXPECT_NEAR(depth_along_x(ball(0, 2, medium("interior", 0.5f)) + ball(0, 1, priority(1))), 2 * 0.5, kRounding);
}

TEST(Priority, BoundariesInsideSomethingHigherAreNotThere) {
  // Glass with a dye inside a ball that counts more: neither its refraction nor its reflection shows.
  const std::string dye = medium("interior", 3, priority(1)), dark = medium("interior", 0.5f, priority(2));
  EXPECT_NEAR(depth_along_x(ball(0, 2, dark) + ball(0, 1, dye, "dielectric")), 4 * 0.5, kRounding);
  // Opaque ones too, as long as they have a medium.
  EXPECT_NEAR(depth_along_x(ball(0, 2, dark) + ball(0, 1, dye, "diffuse")), 4 * 0.5, kRounding);
}

TEST(Priority, TheSensorMayStandInTheOverlap) {
  const std::string a = medium("interior", 0.3f, priority(2)), b = medium("interior", 1.1f, priority(1));
  EXPECT_NEAR(depth_along_x(ball(-0.5f, 1, a) + ball(0.5f, 1, b), 0), 0.5 * 0.3 + 1 * 1.1, kRounding);
  EXPECT_NEAR(depth_along_x(ball(0.5f, 1, b) + ball(-0.5f, 1, a), 0), 0.5 * 0.3 + 1 * 1.1, kRounding);
}

TEST(Priority, AnOpenBoundaryEncloses) {
  // A disk at x = 0 whose outside faces the sensor: behind it the medium goes on to the end of the world, which is as
  // far away as the sensor.
  const std::string disk =
      "<shape type=\"disk\"><transform name=\"to_world\"><rotate y=\"1\" angle=\"-90\"/></transform><bsdf "
      "type=\"null\"/>" +
      medium("interior", 0.2f, priority(0)) + "</shape>";
  const double end = 10;
  EXPECT_NEAR(depth_along_x(disk), end * 0.2, 2e-4);
  // Seen from behind, one leaves what one is not inside of.
  EXPECT_NEAR(depth_along_x("<shape type=\"disk\"><transform name=\"to_world\"><rotate y=\"1\" "
                            "angle=\"90\"/></transform><bsdf type=\"null\"/>" +
                            medium("interior", 0.2f, priority(0)) + "</shape>"),
              0, kRounding);
}

TEST(World, FillsWhatNothingEncloses) {
  const std::string world = medium("world", 0.1f);
  const double radius = std::sqrt(3.0) * 2, from = 10, length = from + Scene::kWorldScale * radius;
  EXPECT_NEAR(depth_along_x(world + ball(0, 2, medium("interior", 0.5f))), (length - 4) * 0.1 + 4 * 0.5, 2e-4);
  // A sensor within stands in the ball, not in the world.
  EXPECT_NEAR(depth_along_x(world + ball(0, 2, medium("interior", 0.5f)), 0),
              (Scene::kWorldScale * radius - 2) * 0.1 + 2 * 0.5, 2e-4);
}

TEST(World, GlassWithoutAMediumIsEmpty) {
  const std::string glass =
      "<shape type=\"sphere\"><float name=\"radius\" value=\"2\"/><bsdf type=\"dielectric\"><float name=\"int_ior\" "
      "value=\"1.0000001\"/><float name=\"ext_ior\" value=\"1\"/></bsdf></shape>";
  const double length = 10 + double{Scene::kWorldScale} * std::sqrt(3.0) * 2;
  EXPECT_NEAR(depth_along_x(medium("world", 0.1f) + glass), (length - 4) * 0.1, 2e-4);
}

TEST(World, OpaqueRoomsAreFilledToo) {
  const std::string room = R"(<shape type="cube"><transform name="to_world"><scale value="3"/></transform>
    <emitter type="area"><rgb name="radiance" value="1"/></emitter><boolean name="flip_normals" value="true"/></shape>)";
  EXPECT_NEAR(depth_along_x(medium("world", 0.1f) + room, -2), 5 * 0.1, kRounding);
}

/// Light that comes to a diffuse wall through an overlap, by next-event estimation alone.
TEST(Priority, ShadowRaysFindTheSameMedia) {
  const auto wall_behind = [](const std::string& content) {
    const std::string scene = R"(<scene version="3.0.0">
    <integrator type="volpath"><integer name="max_depth" value="2"/></integrator>
    <sensor type="perspective"><float name="fov" value="0.001"/>
      <transform name="to_world"><lookat origin="2,3,0" target="3,0,0" up="0,0,1"/></transform>
      <film type="hdrfilm"><integer name="width" value="1"/><integer name="height" value="1"/></film></sensor>
    <shape type="rectangle"><transform name="to_world"><rotate y="1" angle="-90"/><translate x="3"/></transform></shape>
    <emitter type="point"><point name="position" value="-4,0,0"/><rgb name="intensity" value="100"/></emitter>)" +
                              content + "</scene>";
    const Film film = render_text(scene, 4);
    return film.pixel(0).radiance[0] / static_cast<double>(film.samples());
  };
  const double clear = wall_behind("");
  ASSERT_GT(clear, 0);
  const std::string a = medium("interior", 0.3f, priority(2)), b = medium("interior", 1.1f, priority(1));
  const double through = wall_behind(ball(-0.5f, 1, a) + ball(0.5f, 1, b, "dielectric") + ball(0.5f, 1.2f, a));
  EXPECT_NEAR(-std::log(through / clear), 0.3 * (2.0 + 0.2 + 1.0), 1e-4);
}

}  // namespace
}  // namespace turbid::testing
