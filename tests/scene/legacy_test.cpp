// Scenes of Mitsuba 0.4 to 0.6.
#include "scene/legacy.h"

#include <gtest/gtest.h>

#include "reading.h"

namespace turbid::testing {
namespace {

SceneDocument read_legacy(const std::string& content) {
  return read_document_from_string("<scene version=\"0.6.0\">\n" + content + "\n</scene>", "test.xml");
}
std::string legacy_complaint(const std::string& content) {
  return complaint([&] { load_scene_from_string("<scene version=\"0.6.0\">\n" + content + "\n</scene>", "test.xml"); });
}
const SceneNode& first(const SceneDocument& document) { return *document.root->children.at(0).node; }
bool has(const SceneNode& node, const std::string& name) {
  for (const NamedValue& value : node.values)
    if (value.name == name) return true;
  return false;
}

TEST(Legacy, NamesBecomeSnakeCase) {
  EXPECT_EQ(snake_case("toWorld"), "to_world");
  EXPECT_EQ(snake_case("intIOR"), "int_ior");
  EXPECT_EQ(snake_case("sigmaS"), "sigma_s");
  EXPECT_EQ(snake_case("highQualityEdges"), "high_quality_edges");
  EXPECT_EQ(snake_case("to_world"), "to_world");
  EXPECT_EQ(snake_case("A"), "A");
  EXPECT_EQ(snake_case(""), "");
}

TEST(Legacy, ParametersTransformsAndReferences) {
  const SceneDocument document = read_legacy(
      "<shape type=\"obj\"><boolean name=\"faceNormals\" value=\"true\"/>\n"
      "<transform name=\"toWorld\"><lookAt origin=\"0,0,1\" target=\"0,0,0\" up=\"0,1,0\"/></transform>\n"
      "<medium type=\"homogeneous\" name=\"interior\"><rgb name=\"sigmaS\" value=\"1\"/></medium></shape>");
  const SceneNode& shape = first(document);
  EXPECT_TRUE(first_value<bool>(document, "face_normals"));
  EXPECT_NEAR(first_value<Transform>(document, "to_world").at(2, 3), 1, 1e-12);
  EXPECT_EQ(shape.children.at(0).name, "interior");
  EXPECT_TRUE(has(*shape.children[0].node, "sigma_s"));
  EXPECT_EQ(shape.children[0].node->where.line, 4);
}

TEST(Legacy, TodaysScenesKeepTheirNames) {
  EXPECT_TRUE(
      has(first(read("<shape type=\"obj\"><boolean name=\"faceNormals\" value=\"true\"/></shape>")), "faceNormals"));
}

TEST(Legacy, TextureScalesAndOffsetsBecomeOneTransform) {
  const SceneDocument document = read_legacy(
      "<texture type=\"checkerboard\"><float name=\"uscale\" value=\"4\"/><float name=\"vscale\" value=\"2\"/>"
      "<float name=\"uoffset\" value=\"0.5\"/></texture>");
  const auto to_uv = first_value<Transform>(document, "to_uv");
  EXPECT_EQ(to_uv.point(Vec3(1, 1, 0)), Vec3(4.5f, 2, 0));  // uv * scale + offset, as 0.6 has it
  EXPECT_EQ(first(document).values.size(), 1u);
  EXPECT_EQ(legacy_complaint("<texture type=\"checkerboard\"><float name=\"uscale\" value=\"0\"/></texture>"),
            "3 test.xml:2:58: 'uscale' and 'vscale' must not be 0");
}

TEST(Legacy, ColoursWithoutWavelengthsAreRgb) {
  const SceneDocument document = read_legacy(
      "<emitter type=\"point\"><spectrum name=\"a\" value=\"10\"/><spectrum name=\"b\" value=\"1, 2, 3\"/>"
      "<srgb name=\"c\" value=\"1, 0.5, 0\"/><srgb name=\"d\" value=\"#ff0000\"/></emitter>");
  EXPECT_EQ(first_value<Spectrum>(document, "a"), Spectrum(10.0f));
  EXPECT_EQ(first_value<Spectrum>(document, "b"), Spectrum(1, 2, 3));
  EXPECT_NEAR(first_value<Spectrum>(document, "c")[1], 0.2140411f, 1e-6f);
  EXPECT_EQ(first_value<Spectrum>(document, "d"), Spectrum(1, 0, 0));
}

TEST(Legacy, PluginsThatHaveAnotherNameToday) {
  EXPECT_EQ(first(read_legacy("<integrator type=\"volpath_simple\"/>")).type, "volpath");
  EXPECT_EQ(first(read_legacy("<sampler type=\"halton\"><integer name=\"scramble\" value=\"1\"/></sampler>")).type,
            "sobol");
  const SceneDocument film = read_legacy(
      "<film type=\"ldrfilm\"><integer name=\"width\" value=\"8\"/><boolean name=\"banner\" value=\"false\"/>"
      "<float name=\"gamma\" value=\"2.2\"/></film>");
  EXPECT_EQ(first(film).type, "hdrfilm");
  EXPECT_EQ(first(film).values.size(), 1u);
  const SceneDocument medium = read_legacy(
      "<medium type=\"heterogeneous\"><volume type=\"constvolume\" name=\"density\"/>"
      "<string name=\"method\" value=\"woodcock\"/></medium>");
  EXPECT_EQ(first(medium).children.at(0).name, "sigma_t");
  EXPECT_TRUE(first(medium).values.empty());
  const SceneDocument bsdf =
      read_legacy("<bsdf type=\"diffuse\"><rgb name=\"diffuseReflectance\" value=\"1\"/></bsdf>");
  EXPECT_TRUE(has(first(bsdf), "reflectance"));
}

TEST(Legacy, BitmapsWithGamma) {
  const auto bitmap = [](const std::string& gamma) {
    return "<texture type=\"bitmap\"><float name=\"gamma\" value=\"" + gamma +
           "\"/><string name=\"filterType\" value=\"ewa\"/></texture>";
  };
  const SceneDocument plain = read_legacy(bitmap("1"));
  EXPECT_TRUE(first_value<bool>(plain, "raw"));
  EXPECT_EQ(first_value<std::string>(plain, "filter_type"), "bilinear");
  EXPECT_FALSE(has(first(read_legacy(bitmap("-1"))), "raw"));
  EXPECT_EQ(legacy_complaint(bitmap("1.8")),
            "3 test.xml:2:51: a gamma of 1.8 is not supported, only 1 (plain numbers) or none (as the file says, "
            "usually sRGB)");
}

TEST(Legacy, AWholeSceneLoads) {
  const LoadedScene scene = load_scene_from_string(R"(<scene version="0.5.0">
  <integrator type="volpath_simple"><integer name="maxDepth" value="8"/><boolean name="strictNormals" value="true"/>
  </integrator>
  <sensor type="perspective"><float name="fov" value="45"/><float name="nearClip" value="0.1"/>
    <string name="fovAxis" value="smaller"/>
    <transform name="toWorld"><lookAt origin="0,0,5" target="0,0,0" up="0,1,0"/></transform>
    <sampler type="ldsampler"><integer name="sampleCount" value="64"/></sampler>
    <film type="hdrfilm"><integer name="width" value="16"/><integer name="height" value="12"/>
      <string name="pixelFormat" value="rgb"/><boolean name="banner" value="false"/><rfilter type="gaussian"/></film>
  </sensor>
  <medium type="homogeneous" id="milk"><rgb name="sigmaS" value="2"/><rgb name="sigmaA" value="0.1"/>
    <phase type="hg"><float name="g" value="0.5"/></phase></medium>
  <shape type="sphere"><bsdf type="dielectric"><float name="intIOR" value="1.33"/><float name="extIOR" value="1"/></bsdf>
    <ref name="interior" id="milk"/></shape>
  <emitter type="constant"><spectrum name="radiance" value="1"/></emitter></scene>)",
                                                   "old.xml");
  EXPECT_EQ(scene.parts.film.size, Vec2i(16, 12));
  EXPECT_EQ(scene.parts.sample_count, 64u);
  EXPECT_EQ(scene.integrator.node->type, "volpath");
  EXPECT_EQ(scene.parts.objects.at(0).interior->sigma_t(), Spectrum(2.1f));
}

}  // namespace
}  // namespace turbid::testing
