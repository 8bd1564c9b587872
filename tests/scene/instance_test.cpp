#include "geometry/instance.h"

#include <fstream>

#include "reading.h"
#include "testing/temporary_folder.h"

namespace turbid::testing {
namespace {

std::vector<Object> objects_of(const std::string& content) {
  return load_scene_from_string(scene_of(content), "test.xml").parts.objects;
}

const std::string kGroup = R"(
  <bsdf type="dielectric" id="glass"/>
  <shape type="shapegroup" id="pair">
    <shape type="sphere" id="ball"><ref id="glass"/><medium name="interior" type="homogeneous"/></shape>
    <shape type="merge"><shape type="cube" id="box"/></shape>
  </shape>)";

TEST(Instances, EachMemberOfEachInstanceIsAnObject) {
  const auto objects = objects_of(kGroup + R"(
    <shape type="instance"><ref id="pair"/></shape>
    <shape type="disk" id="disk"/>
    <shape type="instance"><ref name="anything" id="pair"/>
      <transform name="to_world"><scale value="2"/><translate x="10"/></transform></shape>)");
  ASSERT_EQ(objects.size(), 5u);
  const char* ids[] = {"ball", "box", "disk", "ball", "box"};
  for (size_t i = 0; i < 5; ++i) EXPECT_EQ(objects[i].id, ids[i]);
  EXPECT_EQ(objects[0].bsdf, objects[3].bsdf);
  EXPECT_TRUE(objects[3].bounds_media);
  EXPECT_EQ(objects[0].interior, objects[3].interior);
  EXPECT_EQ(objects[4].interior, nullptr);
  const auto& first = dynamic_cast<const ShapeInstance&>(*objects[0].shape);
  const auto& second = dynamic_cast<const ShapeInstance&>(*objects[3].shape);
  EXPECT_EQ(&first.placement().group(), &second.placement().group());
  EXPECT_EQ(objects[4].shape->bounds().min, Vec3(8, -2, -2));
  EXPECT_EQ(objects[4].shape->bounds().max, Vec3(12, 2, 2));
}

TEST(Instances, AGroupAloneIsNotSeen) { EXPECT_TRUE(objects_of(kGroup).empty()); }

TEST(Instances, AnInstanceMayStandBeforeItsGroupOrHoldIt) {
  EXPECT_EQ(objects_of("<shape type=\"instance\"><ref id=\"pair\"/></shape>" + kGroup).size(), 2u);
  EXPECT_EQ(
      objects_of(R"(<shape type="instance"><shape type="shapegroup"><shape type="cube"/></shape></shape>)").size(), 1u);
}

TEST(Instances, MergeIsTransparent) {
  const auto objects = objects_of(kGroup + R"(
    <shape type="merge">
      <shape type="cube" id="a"/>
      <shape type="merge"><shape type="disk" id="b"/><shape type="instance"><ref id="pair"/></shape></shape>
    </shape>)");
  ASSERT_EQ(objects.size(), 4u);
  EXPECT_EQ(objects[0].id, "a");
  EXPECT_EQ(objects[1].id, "b");
  EXPECT_EQ(objects[2].id, "ball");
}

TEST(Instances, TheSceneFindsWhatAnInstanceIsMadeOf) {
  const Scene scene(load_scene_from_string(scene_of(kGroup + R"(
    <shape type="instance"><ref id="pair"/><transform name="to_world"><translate x="10"/></transform></shape>
    <shape type="instance"><ref id="pair"/><transform name="to_world"><scale value="-2"/></transform></shape>)"),
                                           "test.xml")
                        .parts);
  const Hit hit = scene.rays().intersect({{10, 0, 5}, {0, 0, -1}});
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit.shape, 1u);
  EXPECT_EQ(scene.object(hit).id, "box");
  EXPECT_EQ(scene.object(scene.rays().intersect({{0, 0, 0.5f}, {1, 0, 0}})).id, "ball");
  EXPECT_NE(scene.medium_at({0, 0, 0}), nullptr);  // mirrored: its inside is inside
  EXPECT_EQ(scene.medium_at({1.9f, 1.9f, 1.9f}), nullptr);
}

TEST(SdfGrids, AreReadFromGridFiles) {
  const TemporaryFolder folder;
  const auto write = [&](int32_t channels) {
    std::string bytes = "VOL\3";
    const auto put = [&](auto value) { bytes.append(reinterpret_cast<const char*>(&value), sizeof value); };
    for (const int32_t i : {1, 2, 2, 3, channels}) put(i);
    for (int i = 0; i < 6; ++i) put(0.0f);
    for (int z = 0; z < 3; ++z)
      for (int i = 0; i < 4 * channels; ++i) put(static_cast<float>(z) - 0.5f);
    std::ofstream(folder.file("a.sdf"), std::ios::binary) << bytes;
  };
  const auto scene = [](const std::string& more) {
    return scene_of("<shape type=\"sdfgrid\"><string name=\"filename\" value=\"a.sdf\"/>" + more + "</shape>");
  };
  const auto load = [&](const std::string& more = {}) {
    return load_scene_from_string(scene(more), "test.xml", {}, folder.path()).parts.objects;
  };
  write(1);
  const auto shape = load("<string name=\"normals\" value=\"analytic\"/>").at(0).shape;
  const RayCaster caster({shape});
  EXPECT_NEAR(caster.intersect({{0.3f, 0.6f, 5}, {0, 0, -1}}).t, 4.75f, 1e-6f);
  EXPECT_FALSE(caster.intersect({{1.3f, 0.6f, 5}, {0, 0, -1}}));
  EXPECT_EQ(complaint([&] { load("<emitter type=\"area\"/>"); }).substr(0, 88),
            "3 test.xml:2:62: 'emitter' of shape 'sdfgrid' cannot be given: this shape cannot shine");
  write(3);
  EXPECT_NE(complaint([&] { load(); }).find("an sdfgrid takes a grid of 1 channel, found 3"), std::string::npos);
}

TEST(Instances, SayWhatIsWrong) {
  EXPECT_EQ(load_complaint("<shape type=\"instance\"/>"),
            "3 test.xml:2:1: shape 'instance' needs the parameter 'shapegroup' (a shape: the group)");
  EXPECT_EQ(load_complaint("<shape type=\"instance\"><shape type=\"cube\"/></shape>"),
            "3 test.xml:2:24: 'shapegroup' of shape 'instance' must be one, found shape 'cube'");
  EXPECT_EQ(load_complaint("<shape type=\"shapegroup\"><shape type=\"shapegroup\"/></shape>"),
            "3 test.xml:2:26: shape 'shapegroup' cannot stand in a shapegroup: instances do not nest");
  EXPECT_EQ(load_complaint("<shape type=\"shapegroup\"><bsdf type=\"diffuse\"/></shape>"),
            "3 test.xml:2:26: unknown parameter of shape 'shapegroup': a bsdf without a name");
  EXPECT_EQ(load_complaint("<shape type=\"merge\"><float name=\"radius\" value=\"1\"/></shape>"),
            "3 test.xml:2:34: unknown parameter of shape 'merge': 'radius' (expected one of: shapes)");
  EXPECT_EQ(load_complaint("<shape type=\"cube\"><shape type=\"cube\"/></shape>"),
            "3 test.xml:2:20: unknown parameter of shape 'cube': a shape without a name");
  EXPECT_EQ(load_complaint("<shape type=\"shapegroup\"><shape type=\"cube\"><emitter type=\"area\"/></shape></shape>"),
            "3 test.xml:2:26: shape 'cube' cannot shine in a shapegroup: lights have no instances");
}

}  // namespace
}  // namespace turbid::testing
