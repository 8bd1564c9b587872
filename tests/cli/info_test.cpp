// What `turbid info` says about scenes that are probably not meant so.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "child_process.h"
#include "testing/temporary_folder.h"

namespace turbid {
namespace {

class Info : public ::testing::Test {
 protected:
  /// What info prints about a scene of this content.
  std::string about(const std::string& content, const std::string& integrator = "volpath") const {
    std::ofstream(folder_.file("scene.xml"))
        << "<scene version=\"3.0.0\"><integrator type=\"" << integrator << "\"/><sensor type=\"perspective\">"
        << "<transform name=\"to_world\"><lookat origin=\"0,0,9\" target=\"0,0,0\" up=\"0,1,0\"/></transform>"
        << "<film type=\"hdrfilm\"><integer name=\"width\" value=\"8\"/><integer name=\"height\" value=\"8\"/></film>"
        << "</sensor>" << content << "</scene>";
    const testing::Outcome outcome = testing::run_turbid(folder_.path().string(), {"info", "scene.xml"});
    return outcome.output + outcome.errors;
  }
  static void expect_words(const std::string& text, const std::string& words) {
    EXPECT_NE(text.find(words), std::string::npos) << words << "\n" << text;
  }

  testing::TemporaryFolder folder_;
};

const std::string kSky = "<emitter type=\"constant\"/>", kNull = "<bsdf type=\"null\"/>";
const std::string kFog =
    "<medium name=\"interior\" type=\"homogeneous\"><float name=\"sigma_t\" value=\"4\"/></medium>";

TEST_F(Info, HasNothingToWarnOfInASoundScene) {
  const std::string text = about(kSky + "<shape type=\"sphere\" id=\"cloud\">" + kNull + kFog + "</shape>");
  EXPECT_EQ(text.find("warning"), std::string::npos) << text;
  expect_words(text, "mean free path 0.25 scene units, 0.125 of its extent (2), albedo 0.75");
  expect_words(text, "suited       volpath: shadow rays reach the lights through media and invisible boundaries\n");
}

TEST_F(Info, HasNothingToWarnOfInTheScenesThatShip) {
  const auto root = std::filesystem::path(__FILE__).parent_path().parent_path().parent_path();
  for (const auto& entry : std::filesystem::directory_iterator(root / "scenes")) {
    if (entry.is_directory()) continue;  // parts of scenes
    const testing::Outcome outcome = testing::run_turbid(folder_.path().string(), {"info", entry.path().string()});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
    EXPECT_EQ(outcome.errors, "");
    EXPECT_EQ(outcome.output.find("warning"), std::string::npos) << outcome.output;
  }
}

TEST_F(Info, WarnsOfBoundaries) {
  expect_words(about(kSky + "<shape type=\"disk\" id=\"lid\">" + kNull + kFog + "</shape>"),
               "warning      shape 'lid' bounds a medium and is not closed: light that goes in and not out again stays "
               "in the medium to the end of the world\n");
  expect_words(about(kSky + "<shape type=\"sphere\"><boolean name=\"flip_normals\" value=\"true\"/>" + kNull + kFog +
                     "</shape>"),
               "warning      shape 1 (it has no id) has its normals flipped: its interior medium lies outside of it\n");
  expect_words(about(kSky + "<shape type=\"cube\" id=\"box\">" + kFog + "</shape>"),
               "warning      shape 'box' bounds a medium and its bsdf lets no light through: for an invisible boundary "
               "use 'null'\n");
  expect_words(about(kSky +
                     "<shape type=\"cube\" id=\"lake\"><transform name=\"to_world\"><scale value=\"5000\"/>"
                     "</transform>" +
                     kNull + kFog + "</shape>"),
               "warning      shape 'lake' has triangles of up to 5.7e+04 mean free paths of its medium: leaving one "
               "skips about 6 % of a mean free path (finer triangles skip less)\n");
}

TEST_F(Info, SaysWhichMediaATableAloneMakesTooBright) {
  const auto ball = [](const std::string& albedo) {
    return R"(<shape type="sphere"><bsdf type="null"/><medium name="interior" type="homogeneous">
      <rgb name="sigma_t" value="30"/><rgb name="albedo" value=")" +
           albedo + R"("/></medium></shape>)";
  };
  expect_words(about(ball("0.99")), "without its end it would reflect about 3.5 times as much");
  EXPECT_EQ(about(ball("0.5")).find("without its end"), std::string::npos);
}

TEST_F(Info, WarnsOfSensorsInMediaThatNoShapeDeclares) {
  const std::string text = about("<sensor type=\"perspective\"><medium type=\"homogeneous\"/></sensor>" + kSky);
  EXPECT_EQ(text.find("no shape declares"), std::string::npos) << "the first sensor counts\n" << text;
  std::ofstream(folder_.file("fog.xml")) << "<scene version=\"3.0.0\"><integrator type=\"volpath\"/>"
                                            "<sensor type=\"perspective\"><medium type=\"homogeneous\"/></sensor>"
                                            "<shape type=\"sphere\"/><emitter type=\"constant\"/></scene>";
  expect_words(testing::run_turbid(folder_.path().string(), {"info", "fog.xml"}).output,
               "warning      the sensor stands in a medium that no shape declares: it goes on until a surface that "
               "bounds media, or to the end of the world\n");
}

TEST_F(Info, NamesTheIntegratorThatIgnoresMedia) {
  const std::string words =
      "integrator 'path' ignores media, and the scene has one: 'volpath' shows them (--integrator volpath)\n";
  expect_words(about(kSky + "<shape type=\"sphere\">" + kNull + kFog + "</shape>", "path"), "warning      " + words);
  const testing::Outcome render =
      testing::run_turbid(folder_.path().string(), {"render", "scene.xml", "--spp", "1", "-o", "a.exr"});
  EXPECT_EQ(render.exit_code, 0);
  expect_words(render.errors, words);
}

TEST_F(Info, SaysWhichIntegratorsOfOldArePathTracingHere) {
  expect_words(about(kSky, "sppm"),
               "integrator 'sppm' is not supported: 'volpath' makes the same picture by path tracing "
               "(--integrator volpath)");
}

TEST_F(Info, WarnsOfLightsThatCannotBeFound) {
  expect_words(about("<emitter type=\"point\"><point name=\"position\" value=\"0,5,0\"/></emitter><shape "
                     "type=\"sphere\"><bsdf type=\"dielectric\"/>" +
                     kFog + "</shape>"),
               "warning      integrator 'volpath' misses the light of point, spot and directional lights that comes "
               "through smooth glass or off mirrors: 'bdpt' finds it\n");
  const std::string lamp_in_glass = about(
      "<shape type=\"sphere\"><bsdf type=\"dielectric\"/></shape><shape type=\"sphere\"><float name=\"radius\" "
      "value=\"0.1\"/><emitter type=\"area\"/></shape><shape type=\"sphere\"><float name=\"radius\" value=\"9\"/>" +
      kNull + kFog + "</shape>");
  expect_words(lamp_in_glass, "suited       bdpt: a light stands behind smooth glass");
  expect_words(about("<emitter type=\"collimated\"/>"),
               "warning      integrator 'volpath' misses the light of collimated beams: 'bdpt' finds it\n");
  expect_words(about("<shape type=\"sphere\"/>"), "warning      nothing shines: the picture will be black\n");
}

}  // namespace
}  // namespace turbid
