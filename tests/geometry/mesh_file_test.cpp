#include "geometry/mesh_file.h"

#include <gtest/gtest.h>

#include <bit>
#include <fstream>

#include "core/error.h"
#include "shapes_for_tests.h"
#include "testing/temporary_folder.h"

namespace turbid {
namespace {
using namespace turbid::testing;

class MeshFile : public ::testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& bytes) {
    std::ofstream(folder_.file(name), std::ios::binary) << bytes;
    return folder_.file(name);
  }
  MeshData obj(const std::string& text, const MeshFileOptions& options = {.flip_tex_coords = true}) {
    return load_obj(write("a.obj", text), options);
  }
  MeshData ply(const std::string& bytes, const MeshFileOptions& options = {}) {
    return load_ply(write("a.ply", bytes), options);
  }

  /// The message without the name of the file.
  std::string obj_error(const std::string& text) { return error("a.obj", text); }
  std::string ply_error(const std::string& bytes) { return error("a.ply", bytes); }

  TemporaryFolder folder_;

 private:
  std::string error(const std::string& name, const std::string& bytes) {
    const std::string path = write(name, bytes);
    try {
      name == "a.obj" ? load_obj(path) : load_ply(path);
    } catch (const FileError& e) {
      EXPECT_EQ(e.exit_code(), 4);
      const std::string message = e.what();
      EXPECT_EQ(message.substr(0, path.size() + 2), path + ": ");
      return message.substr(path.size() + 2);
    }
    return "no error";
  }
};

const std::string kSquare = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

TEST_F(MeshFile, ObjPolygonsAreFans) {
  const MeshData m = obj(kSquare + "f 1 2 3 4\n");
  EXPECT_EQ(m.name, "a.obj");
  EXPECT_EQ(m.positions.size(), 4u);
  EXPECT_EQ(m.indices, (std::vector<uint32_t>{0, 1, 2, 0, 2, 3}));
  EXPECT_TRUE(m.uvs.empty());
  ASSERT_EQ(m.normals.size(), 4u);  // computed
  EXPECT_EQ(m.normals[0], Vec3(0, 0, 1));
  EXPECT_TRUE(obj(kSquare + "f 1 2 3 4\n", {.face_normals = true}).normals.empty());
}

TEST_F(MeshFile, ObjSyntaxInAllItsForms) {
  const std::string text =
      "# a comment\r\nmtllib x.mtl\r\no thing\r\ng a b\r\ns 1\r\nusemtl m\r\n"
      "v  +0 0.0e0 0 1.0\r\n\tv 1 \\\r\n 0 0\r\nv 1 1 0 # top\r\nvt 0 0\r\nvt 1 .25 0\r\nvt 0.5\r\nvn 0 0 2\r\n\r\n"
      "f 1/1/1 2/2/1 3/3/1\r\nf -3//-1 -2//-1 -1//-1 # again\r\nl 1 2\r\nf 1/1 2/2 3/3";
  const MeshData m = obj(text);
  EXPECT_EQ(m.triangle_count(), 3u);
  EXPECT_EQ(m.positions.size(), 9u);
  EXPECT_EQ(m.positions[1], Vec3(1, 0, 0));
  EXPECT_EQ(m.uvs[1], Vec2(1, 0.75f));  // flipped by default
  EXPECT_EQ(m.uvs[2], Vec2(0.5f, 1));
  EXPECT_EQ(obj(text, {}).uvs[1], Vec2(1, 0.25f));
  EXPECT_EQ(m.normals[0], Vec3(0, 0, 1));
  EXPECT_EQ(m.normals[8], Vec3(0, 0, 0));  // none given for this corner
}

TEST_F(MeshFile, ObjSharesCornersThatAreEqual) {
  const MeshData m = obj(kSquare + "vt 0 0\nvt 1 1\nf 1/1 2/1 3/1\nf 1/1 3/1 4/1\nf 1/2 3/1 4/1\n");
  EXPECT_EQ(m.positions.size(), 5u);
}

TEST_F(MeshFile, ObjTransforms) {
  const MeshData m = obj(kSquare + "vn 0 0 1\nf 1//1 2//1 3//1\n",
                         {.to_world = Transform::translate(0, 0, 5) * Transform::scale(1, 1, -1)});
  EXPECT_EQ(m.positions[1], Vec3(1, 0, 5));
  EXPECT_EQ(m.normals[0], Vec3(0, 0, -1));
  EXPECT_LT(TriangleMesh(m).point_on_triangle(0, {0.3f, 0.3f}).ng.z, -0.9f);
}

TEST_F(MeshFile, ObjErrorsNameTheLine) {
  EXPECT_EQ(obj_error(""), "there are no faces ('f' lines)");
  EXPECT_EQ(obj_error(kSquare), "there are no faces ('f' lines)");
  EXPECT_EQ(obj_error("v 0 0\n"), "line 1: expected a number of a vertex position, found ''");
  EXPECT_EQ(obj_error("v 0 zero 0\n"), "line 1: expected a number of a vertex position, found 'zero'");
  EXPECT_EQ(obj_error("v 0 0 nan\n"), "line 1: a vertex position is not finite");
  EXPECT_EQ(obj_error("\nv 0 0 1e39\n"), "line 2: a vertex position is not finite");
  EXPECT_EQ(obj_error("vt\n"), "line 1: expected a number of a texture coordinate, found ''");
  EXPECT_EQ(obj_error(kSquare + "f 1 2 5\n"), "line 5: a face refers to vertex 5, but there are 4 so far");
  EXPECT_EQ(obj_error(kSquare + "f 1 2 0\n"), "line 5: a face refers to vertex 0, but there are 4 so far");
  EXPECT_EQ(obj_error(kSquare + "f 1 2 -5\n"), "line 5: a face refers to vertex -5, but there are 4 so far");
  EXPECT_EQ(obj_error(kSquare + "f 1/1 2/1 3/1\n"),
            "line 5: a face refers to texture coordinate 1, but there are 0 so far");
  EXPECT_EQ(obj_error(kSquare + "f 1//1 2//1 3//1\n"), "line 5: a face refers to normal 1, but there are 0 so far");
  EXPECT_EQ(obj_error(kSquare + "f 1 2\n"), "line 5: a face needs at least 3 corners, found 2");
  EXPECT_EQ(obj_error(kSquare + "f 1 2 x\n"), "line 5: expected the index of a vertex, found 'x'");
  EXPECT_EQ(obj_error(kSquare + "f 1 2 3x\n"), "line 5: unexpected 'x' after a face corner");
  EXPECT_EQ(obj_error(kSquare + "f 1 2 99999999999999999999\n"),
            "line 5: expected the index of a vertex, found '99999999999999999999'");
  EXPECT_THROW(load_obj(folder_.file("missing.obj")), FileError);
  EXPECT_THROW(load_obj(folder_.path()), FileError);
}

const std::string kAsciiHeader =
    "ply\nformat ascii 1.0\ncomment made by hand\nelement vertex 3\nproperty float x\nproperty float y\nproperty float "
    "z\n"
    "element face 1\nproperty list uchar int vertex_indices\nend_header\n";

TEST_F(MeshFile, PlyAscii) {
  const MeshData m = ply(kAsciiHeader + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  EXPECT_EQ(m.positions[2], Vec3(0, 1, 0));
  EXPECT_EQ(m.indices, (std::vector<uint32_t>{0, 1, 2}));
  EXPECT_EQ(m.normals[0], Vec3(0, 0, 1));
}

/// Bytes of a value in the byte order asked for.
template <class T>
std::string bytes(T value, bool big) {
  std::string s(sizeof value, '\0');
  std::memcpy(s.data(), &value, sizeof value);
  if (big) std::reverse(s.begin(), s.end());
  return s;
}

TEST_F(MeshFile, PlyBinaryOfBothOrdersWithAllKindsOfProperties) {
  for (const bool big : {false, true}) {
    std::string file =
        std::string("ply\r\nformat binary_") + (big ? "big" : "little") +
        "_endian 1.0\r\nobj_info x\r\nelement camera 1\r\nproperty double f\r\nproperty list ushort short more\r\n"
        "element vertex 4\r\nproperty uchar red\r\nproperty uchar green\r\nproperty uchar blue\r\nproperty double x\r\n"
        "property float32 y\r\nproperty int16 z\r\nproperty float nx\r\nproperty float ny\r\nproperty float nz\r\n"
        "property float s\r\nproperty float t\r\nproperty float heat\r\nproperty list uchar uchar tags\r\n"
        "element face 1\r\nproperty int8 kind_0\r\nproperty list uint32 ushort vertex_index\r\nend_header\r\n";
    file += bytes(1.5, big) + bytes(uint16_t{2}, big) + bytes(int16_t{-1}, big) + bytes(int16_t{7}, big);
    const float xy[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    for (int i = 0; i < 4; ++i) {
      file += bytes(uint8_t(255), big) + bytes(uint8_t(0), big) + bytes(uint8_t(i == 0 ? 188 : 0), big);
      file += bytes(double(xy[i][0]), big) + bytes(xy[i][1], big) + bytes(int16_t{-3}, big);
      for (const float v : {0.0f, 0.0f, 1.0f, xy[i][0], 0.25f, float(i)}) file += bytes(v, big);
      file += bytes(uint8_t{1}, big) + bytes(uint8_t{9}, big);
    }
    file += bytes(int8_t{-5}, big) + bytes(uint32_t{4}, big);
    for (uint16_t i = 0; i < 4; ++i) file += bytes(i, big);

    const MeshData m = ply(file);
    EXPECT_EQ(m.positions[2], Vec3(1, 1, -3));
    EXPECT_EQ(m.normals[3], Vec3(0, 0, 1));
    EXPECT_EQ(m.uvs[1], Vec2(1, 0.25f));
    EXPECT_EQ(ply(file, {.flip_tex_coords = true}).uvs[1], Vec2(1, 0.75f));
    EXPECT_EQ(m.indices, (std::vector<uint32_t>{0, 1, 2, 0, 2, 3}));
    const TriangleMesh mesh(m);
    ASSERT_NE(mesh.attribute("vertex_color"), nullptr);
    const Vec3 color = mesh.eval_attribute(*mesh.attribute("vertex_color"), [] {
      SurfacePoint s;
      return s;
    }());
    EXPECT_FLOAT_EQ(color.x, 1);
    EXPECT_EQ(color.y, 0);
    EXPECT_NEAR(color.z, 0.503f, 1e-3f);  // sRGB 188
    EXPECT_EQ(mesh.attribute("vertex_heat")->values, (std::vector<float>{0, 1, 2, 3}));
    EXPECT_EQ(mesh.attribute("face_kind")->values, (std::vector<float>{-5, -5}));
    // Cut off anywhere, it is an error.
    for (size_t length = 0; length < file.size(); length += 7) EXPECT_THROW(ply(file.substr(0, length)), FileError);
  }
}

TEST_F(MeshFile, PlyErrors) {
  const std::string vertices = "0 0 0\n1 0 0\n0 1 0\n";
  const auto header = [](const std::string& from, const std::string& to) {
    std::string h = kAsciiHeader;
    return h.replace(h.find(from), from.size(), to);
  };
  EXPECT_EQ(ply_error(""), "is not a PLY file: it does not begin with 'ply'");
  EXPECT_EQ(ply_error("plyx\n"), "is not a PLY file: it does not begin with 'ply'");
  EXPECT_EQ(ply_error("ply\nformat ascii 1.0\n"), "line 3: the header ends without 'end_header'");
  EXPECT_EQ(ply_error(header("ascii", "text")),
            "line 2: unknown format 'text', expected ascii, binary_little_endian or binary_big_endian");
  EXPECT_EQ(ply_error(header("1.0", "2.0")), "line 2: unknown format version '2.0', expected 1.0");
  EXPECT_EQ(ply_error(header("format ascii 1.0\n", "")), "the header has no 'format' line");
  EXPECT_EQ(ply_error(header("comment", "remark")), "line 3: unknown header line 'remark'");
  EXPECT_EQ(ply_error(header("vertex 3", "vertex many")),
            "line 4: the number of 'vertex' elements is not a count: 'many'");
  EXPECT_EQ(ply_error(header("vertex 3", "vertex -3")), "line 4: the number of 'vertex' elements is not a count: '-3'");
  EXPECT_EQ(ply_error(header("float x", "real x")), "line 5: unknown property type 'real'");
  EXPECT_EQ(ply_error(header("float x", "float w") + vertices + "3 0 1 2\n"), "the vertices have no x, y, z");
  EXPECT_EQ(ply_error(header("uchar int", "float int")), "line 9: the length of a list must have an integer type");
  EXPECT_EQ(ply_error(header("vertex_indices", "corners") + vertices + "3 0 1 2\n"),
            "the faces have no list 'vertex_indices' or 'vertex_index'");
  EXPECT_EQ(ply_error(header("element vertex 3\n", "")), "line 4: a property before the first element");
  EXPECT_EQ(ply_error(header("float x", "float x y")), "line 5: unexpected 'y' at the end of a header line");
  EXPECT_EQ(ply_error(header("face 1", "face 0") + vertices), "there are no faces");
  EXPECT_EQ(ply_error(kAsciiHeader + vertices + "3 0 1 3\n"), "a face refers to vertex 3, but there are 3");
  EXPECT_EQ(ply_error(kAsciiHeader + vertices + "3 0 1 -2\n"), "the vertex index -2 is out of range, in face 0");
  EXPECT_EQ(ply_error(kAsciiHeader + vertices + "2 0 1\n"), "fewer than 3 corners (2) in face 0");
  EXPECT_EQ(ply_error(kAsciiHeader + vertices + "3 0 1\n"), "the file ends in the middle of face 0");
  EXPECT_EQ(ply_error(kAsciiHeader + vertices + "3 0 1 1.5\n"), "line 14: '1.5' is not a whole number, in face 0");
  EXPECT_EQ(ply_error(kAsciiHeader + "0 0 0\n1 x 0\n0 1 0\n3 0 1 2\n"), "line 12: 'x' is not a number, in vertex 1");
  EXPECT_EQ(ply_error(kAsciiHeader + "0 0 0\n1 nan 0\n0 1 0\n3 0 1 2\n"), "y is not finite, in vertex 1");
}

TEST_F(MeshFile, PlyClaimsAreCheckedBeforeMemoryIsAsked) {
  std::string h = kAsciiHeader;
  h.replace(h.find("vertex 3"), 8, "vertex 2000000000");
  EXPECT_EQ(ply_error(h + "0 0 0\n"),
            "the header claims 2000000000 'vertex' elements of at least 6 bytes each, but only 6 bytes of data are "
            "left in the file");
  h = kAsciiHeader;
  h.replace(h.find("ascii"), 5, "binary_little_endian");
  h.replace(h.find("face 1"), 6, "face 18446744073709551615");
  EXPECT_EQ(ply_error(h + std::string(36, '\0')),
            "the header claims 18446744073709551615 'face' elements of at least 1 bytes each, but only 0 bytes of data "
            "are left in the file");
}

TEST_F(MeshFile, AMillionTrianglesLoadQuickly) {
  const MeshData big = make_uv_sphere(1, 1000, 501);
  std::string file = "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(big.positions.size()) +
                     "\nproperty float x\nproperty float y\nproperty float z\nelement face " +
                     std::to_string(big.triangle_count()) + "\nproperty list uchar int vertex_indices\nend_header\n";
  file.append(reinterpret_cast<const char*>(big.positions.data()), big.positions.size() * sizeof(Vec3));
  for (size_t i = 0; i < big.indices.size(); i += 3) {
    file.push_back(3);
    file.append(reinterpret_cast<const char*>(&big.indices[i]), 12);
  }
  const MeshData m = ply(file);
  EXPECT_EQ(m.triangle_count(), 1'000'000u);
  EXPECT_EQ(m.indices, big.indices);
  EXPECT_EQ(m.positions, big.positions);
}
}  // namespace
}  // namespace turbid
