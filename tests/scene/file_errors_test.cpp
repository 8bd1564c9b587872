// Files that are missing, damaged or lie: the message says where, and shows the line.
#include <fstream>

#include "reading.h"
#include "testing/temporary_folder.h"

namespace turbid::testing {
namespace {

/// A folder of files; complaints name them without the folder.
class FileErrors : public ::testing::Test {
 protected:
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_.path() / name, std::ios::binary) << text;
  }
  std::string load_complaint(const std::string& name, const Overrides& overrides = {}) const {
    std::string text = complaint([&] { load_scene(folder_.path() / name, overrides); });
    const std::string prefix = folder_.path().string();
    for (size_t at; (at = text.find(prefix)) != std::string::npos;) text.replace(at, prefix.size(), "FOLDER");
    return text;
  }
  /// A scene with one mesh in a file of that name.
  std::string complaint_about_mesh(const std::string& type, const std::string& name, const std::string& text) const {
    write(name, text);
    write("main.xml",
          scene_of("<shape type=\"" + type + "\"><string name=\"filename\" value=\"" + name + "\"/></shape>"));
    return load_complaint("main.xml");
  }

  TemporaryFolder folder_;
};

TEST_F(FileErrors, ASceneThatIsNotThere) {
  EXPECT_EQ(load_complaint("none.xml"), "4 FOLDER/none.xml: the file does not exist");
  EXPECT_EQ(load_complaint("."), "4 FOLDER/.: is a folder, expected a scene file");
}

TEST_F(FileErrors, ATruncatedScene) {
  write("main.xml", "<scene version=\"3.0.0\">\r\n\t<shape type=\"sphere\">\r\n\t\t<float name=\"rad");
  EXPECT_EQ(load_complaint("main.xml"),
            "3 FOLDER/main.xml:3:16: this is not well-formed XML: error parsing element attribute\n  |   <float "
            "name=\"rad\n  |                ^");
}

TEST_F(FileErrors, ShowsTheLineAndACaret) {
  write("main.xml", scene_of("  <bsdf type=\"diffuse\">\n    <rgb name=\"reflectence\" value=\"0.5\"/>\n  </bsdf>"));
  EXPECT_EQ(load_complaint("main.xml"),
            "3 FOLDER/main.xml:3:16: unknown parameter of bsdf 'diffuse': 'reflectence', did you mean 'reflectance'?\n "
            " |     <rgb name=\"reflectence\" value=\"0.5\"/>\n  |                ^");
}

TEST_F(FileErrors, AnEmptySceneAndOneThatIsNotText) {
  write("main.xml", "");
  EXPECT_EQ(load_complaint("main.xml"), "3 FOLDER/main.xml:1:1: this is not well-formed XML: it is empty");
  write("main.xml", std::string("\xff\xfe<\0s\0", 6));
  EXPECT_EQ(load_complaint("main.xml"),
            "3 FOLDER/main.xml:1: this is not text in UTF-8 (it has bytes that are zero)\n  | \xFF\xFE<");
  write("main.xml", "<scene version=\"3.0.0\"/><scene version=\"3.0.0\"/>");
  EXPECT_EQ(load_complaint("main.xml"),
            "3 FOLDER/main.xml:1:25: a scene file has one root, found <scene> after <scene>\n  | <scene "
            "version=\"3.0.0\"/><scene version=\"3.0.0\"/>\n  |                         ^");
  write("main.xml", "<bsdf version=\"3.0.0\" type=\"diffuse\"/>");
  EXPECT_EQ(load_complaint("main.xml"),
            "3 FOLDER/main.xml:1:1: the root is <bsdf>, expected <scene>\n  | <bsdf version=\"3.0.0\" "
            "type=\"diffuse\"/>\n  | ^");
}

TEST_F(FileErrors, VersionsThatCannotBeRead) {
  write("main.xml", "<scene version=\"0.3.0\"/>");
  EXPECT_EQ(load_complaint("main.xml"),
            "3 FOLDER/main.xml:1:17: this is a scene for Mitsuba 0.3.0; only scenes of version 0.4.0 or later can be "
            "read (Mitsuba 0.6 saves older ones as 0.6.0)\n  | <scene version=\"0.3.0\"/>\n  |                 ^");
  write("main.xml", "<scene version=\"new\"/>");
  EXPECT_EQ(load_complaint("main.xml"),
            "3 FOLDER/main.xml:1:17: 'new' is not a version, expected for instance 3.0.0\n  | <scene "
            "version=\"new\"/>\n  |                 ^");
  write("main.xml", "<scene/>");
  EXPECT_EQ(load_complaint("main.xml"),
            "3 FOLDER/main.xml:1:1: <scene> needs the attribute 'version', for instance version=\"3.0.0\"\n  | "
            "<scene/>\n  | ^");
}

TEST_F(FileErrors, Includes) {
  write("main.xml", scene_of("<include filename=\"other.xml\"/>"));
  EXPECT_EQ(load_complaint("main.xml"),
            "3 FOLDER/main.xml:2:20: there is no file 'other.xml' (looked in: FOLDER)\n  | <include "
            "filename=\"other.xml\"/>\n  |                    ^");
  write("other.xml", scene_of("<include filename=\"main.xml\"/>"));
  EXPECT_EQ(load_complaint("main.xml"),
            "3 FOLDER/other.xml:2:20: cyclic include: 'main.xml' is already being read\n  | <include "
            "filename=\"main.xml\"/>\n  |                    ^");
  write("other.xml", "<shape type=\"sphere\">");
  EXPECT_EQ(load_complaint("main.xml"),
            "3 FOLDER/other.xml:1:21: this is not well-formed XML: the file ends before all tags are closed\n  | "
            "<shape type=\"sphere\">\n  |                     ^");
}

TEST_F(FileErrors, TagsNestedTooDeeply) {
  std::string open, close;
  for (int i = 0; i < 100000; ++i) open += "<bsdf type=\"mask\">", close += "</bsdf>";
  write("main.xml", "<scene version=\"3.0.0\">\n" + open + close + "</scene>");
  EXPECT_EQ(load_complaint("main.xml"), "3 FOLDER/main.xml:2:3583: tags are nested too deeply");
}

TEST_F(FileErrors, OverridesThatTheSceneDoesNotKnow) {
  write("main.xml", scene_of("<default name=\"resolution\" value=\"1\"/>"));
  EXPECT_TRUE(load_complaint("main.xml", {{"resolution", "4"}}).empty());
  EXPECT_EQ(load_complaint("main.xml", {{"resolutoin", "4"}}),
            "3 FOLDER/main.xml: -D resolutoin=4: the scene has no variable $resolutoin, did you mean 'resolution'?");
}

TEST_F(FileErrors, AMeshThatIsNotThere) {
  write("main.xml", scene_of("<shape type=\"obj\"><string name=\"filename\" value=\"none.obj\"/></shape>"));
  EXPECT_EQ(load_complaint("main.xml"),
            "3 FOLDER/main.xml:2:50: there is no file 'none.obj' (looked in: FOLDER)\n  | <shape type=\"obj\"><string "
            "name=\"filename\" value=\"none.obj\"/></shape>\n  |                                                  ^");
}

TEST_F(FileErrors, Meshes) {
  EXPECT_EQ(complaint_about_mesh("obj", "nan.obj", "v 0 0 0\nv nan 0 0\nv 0 1 0\nf 1 2 3\n"),
            "4 FOLDER/nan.obj: line 2: a vertex position is not finite");
  EXPECT_EQ(complaint_about_mesh("obj", "range.obj", "v 0 0 0\nv 1 0 0\nf 1 2 3\n"),
            "4 FOLDER/range.obj: line 3: a face refers to vertex 3, but there are 2 so far");
  EXPECT_EQ(complaint_about_mesh("obj", "empty.obj", ""), "4 FOLDER/empty.obj: there are no faces ('f' lines)");
  EXPECT_EQ(complaint_about_mesh("ply", "text.ply", "hello"),
            "4 FOLDER/text.ply: is not a PLY file: it does not begin with 'ply'");
  EXPECT_EQ(complaint_about_mesh("ply", "huge.ply",
                                 "ply\nformat binary_little_endian 1.0\nelement vertex 178956970\nproperty float x\n"
                                 "property float y\nproperty float z\nelement face 1\n"
                                 "property list uchar int vertex_indices\nend_header\nabc"),
            "4 FOLDER/huge.ply: the header claims 178956970 'vertex' elements of at least 12 bytes each, but only 3 "
            "bytes of data are left in the file");
}

TEST_F(FileErrors, Pictures) {
  write("bad.png", "this is no picture");
  write("main.xml", scene_of("<emitter type=\"envmap\"><string name=\"filename\" value=\"bad.png\"/></emitter>"));
  EXPECT_EQ(load_complaint("main.xml"),
            "4 FOLDER/bad.png: not a readable picture (EXR, PNG, JPEG, BMP, TGA or HDR): unknown image type");
  write("main.xml",
        scene_of("<texture type=\"bitmap\" id=\"t\"><string name=\"filename\" value=\"none.png\"/></texture>"));
  EXPECT_EQ(load_complaint("main.xml"),
            "3 FOLDER/main.xml:2:62: there is no file 'none.png' (looked in: FOLDER)\n  | <texture type=\"bitmap\" "
            "id=\"t\"><string name=\"filename\" value=\"none.png\"/></texture>\n  |                                    "
            "                          ^");
}

}  // namespace
}  // namespace turbid::testing
