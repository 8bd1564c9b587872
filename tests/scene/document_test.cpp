// Reading XML into nodes: structure, variables, includes, references, values.
#include <fstream>

#include "reading.h"
#include "testing/peer_scenes.h"
#include "testing/temporary_folder.h"

namespace turbid::testing {
namespace {

void write(const std::filesystem::path& path, const std::string& text) {
  std::filesystem::create_directories(path.parent_path());
  std::ofstream(path, std::ios::binary) << text;
}

TEST(Document, KeepsPluginsValuesAndPlaces) {
  const SceneDocument document = read(
      "<shape type=\"sphere\" id=\"ball\">\n"
      "  <float name=\"radius\" value=\" 2.5 \"/>\n"
      "  <point name=\"center\" value=\"1, 2 3\"/>\n"
      "  <bsdf type=\"diffuse\" name=\"skin\"><boolean name=\"b\" value=\"True\"/></bsdf>\n"
      "</shape>");
  ASSERT_EQ(document.root->children.size(), 1u);
  const SceneNode& ball = *document.root->children[0].node;
  EXPECT_EQ(ball.category, Category::kShape);
  EXPECT_EQ(ball.type, "sphere");
  EXPECT_EQ(ball.id, "ball");
  EXPECT_EQ(ball.where.line, 2);
  EXPECT_EQ(ball.where.column, 1);
  EXPECT_EQ(first_value<double>(document, "radius"), 2.5);
  EXPECT_EQ(first_value<Imath::V3d>(document, "center"), Imath::V3d(1, 2, 3));
  EXPECT_EQ(ball.values[0].where.line, 3);
  EXPECT_EQ(ball.values[0].where.column, 31);  // of the text between the quotes
  ASSERT_EQ(ball.children.size(), 1u);
  EXPECT_EQ(ball.children[0].name, "skin");
  EXPECT_TRUE(std::get<bool>(ball.children[0].node->values[0].value));
}

TEST(Document, ReadsEveryTypeOfValue) {
  const SceneDocument document = read(
      "<bsdf type=\"x\"><integer name=\"i\" value=\"-7\"/><string name=\"s\" value=\"a b\"/>"
      "<vector name=\"v\" x=\"1\" y=\"-2\" z=\"3e1\"/><vector name=\"w\" value=\"4\"/>"
      "<rgb name=\"c\" value=\"0.1 0.2, 0.3\"/><rgb name=\"g\" value=\"0.5\"/><rgb name=\"h\" value=\"#ff8000\"/>"
      "<float name=\"f\" value=\"+1e-5\"/></bsdf>");
  EXPECT_EQ(first_value<int64_t>(document, "i"), -7);
  EXPECT_EQ(first_value<std::string>(document, "s"), "a b");
  EXPECT_EQ(first_value<Imath::V3d>(document, "v"), Imath::V3d(1, -2, 30));
  EXPECT_EQ(first_value<Imath::V3d>(document, "w"), Imath::V3d(4, 4, 4));
  EXPECT_EQ(first_value<Spectrum>(document, "c"), Spectrum(0.1f, 0.2f, 0.3f));
  EXPECT_EQ(first_value<Spectrum>(document, "g"), Spectrum(0.5f));
  EXPECT_EQ(first_value<double>(document, "f"), 1e-5);
  const Spectrum orange = first_value<Spectrum>(document, "h");
  EXPECT_EQ(orange[0], 1);
  EXPECT_NEAR(orange[1], 0.2158605, 1e-6);  // sRGB 128/255
  EXPECT_EQ(orange[2], 0);
}

TEST(Document, SubstitutesVariablesAnywhereInAnAttribute) {
  const SceneDocument document = read(
      "<default name=\"a\" value=\"1\"/><default name=\"ab\" value=\"2\"/><default name=\"kind\" value=\"sphere\"/>"
      "<shape type=\"$kind\"><string name=\"s\" value=\"x$a-$abc$a\"/></shape>");
  EXPECT_EQ(document.root->children[0].node->type, "sphere");
  EXPECT_EQ(first_value<std::string>(document, "s"), "x1-2c1");  // the longest name that fits wins: $ab, then "c"
}

TEST(Document, OverridesWinOverDefaultsAndFirstDefaultWins) {
  const std::string content =
      "<default name=\"n\" value=\"1\"/><default name=\"n\" value=\"2\"/>"
      "<shape type=\"s\"><integer name=\"i\" value=\"$n\"/></shape>";
  EXPECT_EQ(first_value<int64_t>(read(content), "i"), 1);
  EXPECT_EQ(first_value<int64_t>(read(content, {{"n", "9"}}), "i"), 9);
}

TEST(Document, ReferencesShareANodeAndMayComeFirst) {
  const SceneDocument document = read(
      "<shape type=\"a\"><ref id=\"late\" name=\"interior\"/></shape><shape type=\"b\"><ref id=\"other\"/></shape>"
      "<medium type=\"m\" id=\"late\"/><alias id=\"late\" as=\"other\"/>");
  const auto& shapes = document.root->children;
  ASSERT_EQ(shapes.size(), 3u);
  EXPECT_EQ(shapes[0].node->children[0].node, shapes[2].node);
  EXPECT_EQ(shapes[1].node->children[0].node, shapes[2].node);
  EXPECT_EQ(shapes[0].node->children[0].name, "interior");
}

TEST(Document, IncludesFilesRelativeToTheSceneThePathsAndTheIncludingFile) {
  const TemporaryFolder folder;
  write(folder.path() / "main.xml",
        "<scene version=\"3.0.0\"><path value=\"lib\"/><include filename=\"parts/outer.xml\"/>"
        "<include filename=\"in_lib.xml\"/></scene>");
  write(folder.path() / "parts/outer.xml",
        "<scene version=\"3.0.0\"><default name=\"n\" value=\"5\"/><include filename=\"beside.xml\"/>"
        "<include filename=\"parts/from_root.xml\"/></scene>");
  write(folder.path() / "parts/beside.xml", "<shape version=\"3.0.0\" type=\"beside$n\"/>");
  write(folder.path() / "parts/from_root.xml", "<shape type=\"from_root\"/>");
  write(folder.path() / "lib/in_lib.xml", "<scene version=\"2.1.0\"><shape type=\"in_lib\"/></scene>");
  write(folder.path() / "lib/mesh.ply", "");
  const SceneDocument document = read_document(folder.path() / "main.xml");
  ASSERT_EQ(document.root->children.size(), 3u);
  EXPECT_EQ(document.root->children[0].node->type, "beside5");
  EXPECT_EQ(document.root->children[1].node->type, "from_root");
  EXPECT_EQ(document.root->children[2].node->type, "in_lib");
  EXPECT_EQ(document.files.size(), 5u);
  EXPECT_EQ(document.resolve("mesh.ply"), folder.path() / "lib/mesh.ply");
  EXPECT_EQ(document.resolve("nowhere.ply"), "nowhere.ply");
}

TEST(Document, ReadsMarkedUtf8AndWindowsLines) {
  const SceneDocument document = read_document_from_string(
      "\xef\xbb\xbf<?xml version=\"1.0\" encoding=\"utf-8\"?>\r\n<!-- \xc3\xbc -->\r\n<scene version=\"3.0.0\">\r\n"
      "<shape type=\"\xc3\xbc\" id=\"\xe6\xb0\xb4\"/>\r\n</scene>\r\n",
      "test.xml");
  EXPECT_EQ(document.root->children[0].node->type, "\xc3\xbc");
  EXPECT_EQ(document.root->children[0].node->where.line, 4);
}

TEST(Document, CountsColumnsInCharacters) {
  EXPECT_EQ(read_complaint("<string name=\"\xc3\xbc\xc3\xbc\" value=\"\"/><nonsense/>"),
            "3 test.xml:2:29: unknown tag <nonsense>");  // 31 in bytes
}

TEST(Document, ReadsSpectraFromFiles) {
  const TemporaryFolder folder;
  write(folder.path() / "flat.spd", "# nm value\n360 2\n\n830 2 # end\n");
  write(folder.path() / "main.xml",
        "<scene version=\"3.0.0\"><bsdf type=\"x\"><spectrum name=\"eta\" filename=\"flat.spd\"/></bsdf></scene>");
  const SceneDocument document = read_document(folder.path() / "main.xml");
  EXPECT_NEAR(first_value<Spectrum>(document, "eta")[1], 2, 5e-3);
  EXPECT_EQ(document.files.size(), 2u);
}

/// Mitsuba's own test scenes, where they are at hand.
TEST(Document, ReadsThePeersScenes) {
  const std::filesystem::path folder = peer_scenes();
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << peer_scenes_absent();
  int count = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with("test_") || entry.path().extension() != ".xml") continue;
    EXPECT_NO_THROW({
      const SceneDocument document = read_document(entry.path(), {{"spp", "4"}});
      EXPECT_GT(document.root->children.size(), 2u) << name;
    }) << name;
    ++count;
  }
  EXPECT_EQ(count, 12);
}

}  // namespace
}  // namespace turbid::testing
