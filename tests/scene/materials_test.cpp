// Materials and textures of outside scenes: what their parameters mean, and what they are told when something is wrong.
#include <fstream>

#include "geometry/triangle_mesh.h"
#include "reading.h"
#include "surface/principled.h"
#include "testing/temporary_folder.h"
#include "texture/constant.h"

namespace turbid::testing {
namespace {

/// The first object's material.
std::shared_ptr<const Bsdf> material(const std::string& bsdf) {
  const LoadedScene scene = load_scene_from_string(scene_of("<shape type=\"sphere\">" + bsdf + "</shape>"), "test.xml");
  return scene.parts.objects.at(0).bsdf;
}

float value(const Bsdf& bsdf, const SurfacePoint& point = {}) {
  const Vec3 given(0, 0, 1), chosen(0.6f, 0, 0.8f);
  return bsdf.eval(point, given, chosen, TransportMode::kRadiance).value[0];
}

TEST(Materials, BlendTakesItsSecondMaterialByWeight) {
  const auto blend = material(
      "<bsdf type=\"blendbsdf\"><float name=\"weight\" value=\"0.25\"/>"
      "<bsdf type=\"diffuse\"><float name=\"reflectance\" value=\"0\"/></bsdf>"
      "<bsdf type=\"diffuse\"><float name=\"reflectance\" value=\"1\"/></bsdf></bsdf>");
  EXPECT_NEAR(value(*blend), 0.25f * 0.8f * kInvPi, 1e-6f);
}

TEST(Materials, MapsTakeTheirTextures) {
  const auto plain = material("<bsdf type=\"diffuse\"><float name=\"reflectance\" value=\"1\"/></bsdf>");
  // A height may have any name, or none.
  for (const char* name : {"", " name=\"arbitrary\"", " name=\"texture\""}) {
    const auto flat = material("<bsdf type=\"bumpmap\"><texture type=\"checkerboard\"" + std::string(name) +
                               "/><bsdf type=\"diffuse\"><float name=\"reflectance\" value=\"1\"/></bsdf></bsdf>");
    SurfacePoint point;
    point.ng = point.shading.n;
    point.dp_du = Vec3(1, 0, 0);
    point.dp_dv = Vec3(0, 1, 0);
    EXPECT_NEAR(value(*flat, point), value(*plain), 1e-6f);
  }
  const std::string nested = "<bsdf type=\"diffuse\"><float name=\"reflectance\" value=\"1\"/></bsdf></bsdf>";
  for (const char* color : {"<rgb name=\"normalmap\" value=\"0.5 0.5 1\"/>",
                            "<texture type=\"rawconstant\" name=\"normalmap\"><vector name=\"value\" value=\"0.5, 0.5, "
                            "1\"/></texture>",
                            "<spectrum type=\"srgb\" name=\"normalmap\"><rgb name=\"color\" value=\"0.5, 0.5, "
                            "1\"/></spectrum>"})
    EXPECT_NEAR(value(*material("<bsdf type=\"normalmap\">" + std::string(color) + nested)), value(*plain), 1e-6f);
  const auto tilted = material(
      "<bsdf type=\"normalmap\"><boolean name=\"use_shadowing_function\" value=\"false\"/><rgb name=\"normalmap\" "
      "value=\"0.8 0.5 0.9\"/>" +
      nested);
  EXPECT_NEAR(value(*tilted), kInvPi, 1e-6f) << "the light comes along the normal (0.6, 0, 0.8)";
}

TEST(Materials, PrincipledReadsItsParameters) {
  const auto metal = material(
      "<bsdf type=\"principled\"><rgb name=\"base_color\" value=\"0.9 0.5 0.2\"/><float name=\"metallic\" "
      "value=\"1\"/><float name=\"roughness\" value=\"0.3\"/><float name=\"anisotropic\" value=\"0.2\"/></bsdf>");
  PrincipledParameters expected;
  const auto number = [&](float v) { return std::make_shared<ConstantTexture>(v); };
  expected.base_color = std::make_shared<ConstantTexture>(Spectrum(0.9f, 0.5f, 0.2f));
  expected.metallic = number(1);
  expected.roughness = number(0.3f);
  expected.anisotropic = number(0.2f);
  EXPECT_FLOAT_EQ(value(*metal), value(Principled(expected)));
  const auto glass = material(
      "<bsdf type=\"principled\"><float name=\"spec_trans\" value=\"1\"/><float name=\"specular\" "
      "value=\"0\"/></bsdf>");
  EXPECT_TRUE(glass->flags() & lobe::kTransmission);
  const auto sheet = material(
      "<bsdf type=\"principledthin\"><float name=\"diff_trans\" value=\"2\"/><float name=\"eta\" "
      "value=\"1.33\"/></bsdf>");
  EXPECT_EQ(value(*sheet), 0) << "all diffuse light goes through";
}

constexpr const char* kSquare =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
    "property float r\nproperty float g\nproperty float b\nelement face 2\nproperty list uchar int vertex_indices\n"
    "property float weight\nend_header\n"
    "0 0 0 1 0 0\n1 0 0 0 1 0\n1 1 0 0 0 1\n0 1 0 1 1 1\n3 0 1 2 0.25\n3 0 2 3 0.75\n";

std::string square_with(const std::string& bsdf) {
  return "<shape type=\"ply\"><string name=\"filename\" value=\"square.ply\"/>" + bsdf + "</shape>";
}

std::string attribute(const std::string& name) {
  return "<texture type=\"mesh_attribute\" name=\"reflectance\"><string name=\"name\" value=\"" + name +
         "\"/></texture>";
}

TEST(Materials, MeshAttributesColourTheMeshThatCarriesThem) {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "square.ply") << kSquare;
  const std::string text = scene_of(square_with("<bsdf type=\"diffuse\">" + attribute("vertex_color") + "</bsdf>") +
                                    square_with("<bsdf type=\"diffuse\">" + attribute("face_weight") + "</bsdf>"));
  const LoadedScene scene = load_scene_from_string(text, "test.xml", {}, folder.path());
  const auto& mesh = dynamic_cast<const TriangleMesh&>(*scene.parts.objects.at(0).shape);
  const Spectrum color = scene.parts.objects[0].bsdf->albedo(mesh.point_on_triangle(0, {0.25f, 0.5f}));
  EXPECT_FLOAT_EQ(color[0], 0.25f);
  EXPECT_FLOAT_EQ(color[1], 0.25f);
  EXPECT_FLOAT_EQ(color[2], 0.5f);
  EXPECT_EQ(scene.parts.objects[1].bsdf->albedo(mesh.point_on_triangle(1, {0.25f, 0.5f})), Spectrum(0.75f));
}

TEST(Materials, MeshAttributesMustBeThere) {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "square.ply") << kSquare;
  const auto complaint_about = [&](const std::string& content) {
    return complaint([&] { load_scene_from_string(scene_of(content), "test.xml", {}, folder.path()); });
  };
  EXPECT_EQ(complaint_about(square_with("\n<bsdf type=\"twosided\"><bsdf type=\"diffuse\">\n" +
                                        attribute("vertex_colour") + "</bsdf></bsdf>")),
            "3 test.xml:4:1: shape 'ply' has no attribute 'vertex_colour', did you mean 'vertex_color'?");
  EXPECT_EQ(complaint_about("<shape type=\"sphere\"><bsdf type=\"diffuse\">\n" + attribute("vertex_color") +
                            "</bsdf></shape>"),
            "3 test.xml:3:1: shape 'sphere' has no attribute 'vertex_color': it has none");
}

struct Malformed {
  std::string content;   ///< of the scene, from line 2 of test.xml
  std::string expected;  ///< exit code and message
};

TEST(Materials, RefuseWhatMakesNoSense) {
  const std::vector<Malformed> cases = {
      {"<bsdf type=\"blendbsdf\"><bsdf type=\"null\"/></bsdf>",
       "3 test.xml:2:1: bsdf 'blendbsdf' needs the parameter 'bsdf_1' (a bsdf: the second material)"},
      {"<bsdf type=\"blendbsdf\"><float name=\"weight\" value=\"1.5\"/><bsdf type=\"null\"/><bsdf "
       "type=\"null\"/></bsdf>",
       "3 test.xml:2:52: 'weight' of bsdf 'blendbsdf' is 1.5, expected a number in [0, 1]"},
      {"<bsdf type=\"bumpmap\"><bsdf type=\"diffuse\"/></bsdf>",
       "3 test.xml:2:1: bsdf 'bumpmap' needs the parameter 'texture' (a texture: the height, scene units; any name "
       "will do)"},
      {"<bsdf type=\"bumpmap\"><texture type=\"mesh_attribute\"><string name=\"name\" "
       "value=\"vertex_h\"/></texture><bsdf type=\"diffuse\"/></bsdf>",
       "3 test.xml:2:22: 'texture' of bsdf 'bumpmap' cannot be a mesh attribute: its slope is not known"},
      {"<bsdf type=\"normalmap\"><rgb name=\"normalmap\" value=\"1 1 1\"/></bsdf>",
       "3 test.xml:2:1: bsdf 'normalmap' needs the parameter 'bsdf' (a bsdf: the material)"},
      {"<bsdf type=\"principled\"><float name=\"eta\" value=\"1.5\"/>\n<float name=\"specular\" "
       "value=\"0.5\"/></bsdf>",
       "3 test.xml:3:31: 'specular' of bsdf 'principled' cannot stand beside 'eta'"},
      {"<bsdf type=\"principled\"><float name=\"rougness\" value=\"1\"/></bsdf>",
       "3 test.xml:2:38: unknown parameter of bsdf 'principled': 'rougness', did you mean 'roughness'?"},
      {"<bsdf type=\"principled\"><float name=\"metallic\" value=\"2\"/></bsdf>",
       "3 test.xml:2:55: 'metallic' of bsdf 'principled' is 2, expected a number in [0, 1]"},
      {"<bsdf type=\"principledthin\"><float name=\"diff_trans\" value=\"2.5\"/></bsdf>",
       "3 test.xml:2:61: 'diff_trans' of bsdf 'principledthin' is 2.5, expected a number in [0, 2]"},
      {"<bsdf type=\"twosided\"><bsdf type=\"principled\"><float name=\"spec_trans\" value=\"1\"/></bsdf></bsdf>",
       "3 test.xml:2:1: bsdf 'twosided': only materials without transmission can be two-sided"},
      {"<texture type=\"mesh_attribute\"><string name=\"name\" value=\"color\"/></texture>",
       "3 test.xml:2:1: texture 'mesh_attribute': the name of a mesh attribute begins with 'vertex_' or 'face_', found "
       "'color'"},
      {"<texture type=\"rawconstant\"><string name=\"value\" value=\"white\"/></texture>",
       "3 test.xml:2:57: 'value' of texture 'rawconstant' expects a float or vector, found a string"},
      {"<bsdf type=\"hair\"/>", "3 test.xml:2:1: bsdf 'hair' is not supported"},
      {"<bsdf type=\"measured\"/>", "3 test.xml:2:1: bsdf 'measured' is not supported"},
      {"<bsdf type=\"polarizer\"/>", "3 test.xml:2:1: bsdf 'polarizer' is not supported"}};
  for (const Malformed& malformed : cases) EXPECT_EQ(load_complaint(malformed.content), malformed.expected);
}

}  // namespace
}  // namespace turbid::testing
