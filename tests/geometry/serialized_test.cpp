#include <gtest/gtest.h>
#include <zlib.h>

#include <fstream>

#include "core/error.h"
#include "geometry/mesh_file.h"
#include "shapes_for_tests.h"
#include "testing/temporary_folder.h"

namespace turbid {
namespace {
using namespace turbid::testing;

template <class T>
void put(std::string& bytes, T value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

/// What a mesh holds before it is compressed.
struct Content {
  int version = 4;
  uint32_t flags = 0x1000;
  uint64_t vertices = 4, triangles = 2;

  template <class Real>
  std::string bytes() const {
    std::string s;
    put(s, flags);
    if (version == 4) s += std::string("a square") + '\0';
    put(s, vertices), put(s, triangles);
    for (const double x : {0., 0., 0., 1., 0., 0., 1., 1., 0., 0., 1., 0.}) put(s, static_cast<Real>(x));
    if (flags & 0x1)
      for (int i = 0; i < 4; ++i) put(s, Real{0}), put(s, Real{3}), put(s, Real{4});
    if (flags & 0x2)
      for (const double x : {0., 0., 1., 0., 1., 0.5, 0., 0.5}) put(s, static_cast<Real>(x));
    if (flags & 0x8)
      for (int i = 0; i < 12; ++i) put(s, static_cast<Real>(i));
    for (const uint32_t i : {0u, 1u, 2u, 0u, 2u, 3u}) put(s, i);
    return s;
  }
};

/// A file of meshes with its table of contents.
std::string file_of(uint16_t version, const std::vector<std::string>& contents) {
  std::string file;
  std::vector<size_t> places;
  for (const std::string& content : contents) {
    places.push_back(file.size());
    put(file, uint16_t{0x041c}), put(file, version);
    std::string packed(compressBound(content.size()), '\0');
    uLongf length = packed.size();
    compress(reinterpret_cast<Bytef*>(packed.data()), &length, reinterpret_cast<const Bytef*>(content.data()),
             content.size());
    file += packed.substr(0, length);
  }
  for (const size_t place : places) version == 4 ? put(file, uint64_t{place}) : put(file, static_cast<uint32_t>(place));
  put(file, static_cast<uint32_t>(contents.size()));
  return file;
}

class Serialized : public ::testing::Test {
 protected:
  MeshData load(const std::string& bytes, int64_t index = 0, const MeshFileOptions& options = {}) {
    std::ofstream(path(), std::ios::binary) << bytes;
    return load_serialized(path(), index, options);
  }
  std::string error(const std::string& bytes, int64_t index = 0) {
    try {
      load(bytes, index);
    } catch (const FileError& e) {
      return std::string(e.what()).substr(path().size() + 2);
    }
    return "no error";
  }
  std::string path() { return folder_.file("a.serialized"); }

  TemporaryFolder folder_;
};

TEST_F(Serialized, ReadsEveryMeshOfBothVersionsAndPrecisions) {
  for (const int version : {3, 4})
    for (const bool is_double : {false, true}) {
      const uint32_t precision = is_double ? 0x2000 : 0x1000;
      const auto bytes = [&](uint32_t flags) {
        const Content content{version, flags | precision};
        return is_double ? content.bytes<double>() : content.bytes<float>();
      };
      const std::string file =
          file_of(static_cast<uint16_t>(version), {bytes(0), bytes(0x1 | 0x2 | 0x8), bytes(0x10), bytes(0x11)});
      const MeshData plain = load(file);
      EXPECT_EQ(plain.positions, (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}));
      EXPECT_EQ(plain.indices, (std::vector<uint32_t>{0, 1, 2, 0, 2, 3}));
      EXPECT_EQ(plain.name, "a.serialized");
      ASSERT_EQ(plain.normals.size(), 4u);  // computed
      EXPECT_EQ(plain.normals[0], Vec3(0, 0, 1));

      const MeshData full = load(file, 1);
      EXPECT_EQ(full.name, "a.serialized@1");
      ASSERT_EQ(full.normals.size(), 4u);
      EXPECT_LT(length(full.normals[3] - Vec3(0, 0.6f, 0.8f)), 1e-6f);
      EXPECT_EQ(full.uvs, (std::vector<Vec2>{{0, 0}, {1, 0}, {1, 0.5f}, {0, 0.5f}}));
      ASSERT_EQ(full.attributes.size(), 1u);
      EXPECT_EQ(full.attributes[0].name, "vertex_color");
      EXPECT_EQ(full.attributes[0].channels, 3);
      EXPECT_EQ(full.attributes[0].values[11], 11);

      EXPECT_TRUE(load(file, 2).normals.empty());  // asks for facets
      EXPECT_TRUE(load(file, 3).normals.empty());
      EXPECT_TRUE(load(file, 1, {.face_normals = true}).normals.empty());
      EXPECT_EQ(load(file, 0, {.to_world = Transform::translate(1, 2, 3)}).positions[1], Vec3(2, 2, 3));
    }
}

TEST_F(Serialized, SaysWhatIsWrong) {
  const std::string good = file_of(4, {Content{}.bytes<float>()});
  EXPECT_EQ(error(good), "no error");
  EXPECT_EQ(error(""), "not a serialized mesh: it does not begin with 0x041C");
  EXPECT_EQ(error("ply\n"), "not a serialized mesh: it does not begin with 0x041C");
  EXPECT_EQ(error(file_of(5, {Content{}.bytes<float>()})),
            "version 5 of serialized meshes is not supported: 3 and 4 are");
  EXPECT_EQ(error(good, 1), "there is no mesh 1: there are 1, from 0");
  EXPECT_EQ(error(good, -1), "there is no mesh -1: there are 1, from 0");
  EXPECT_EQ(error(std::string("\x1c\x04\x04\0\xff\xff\xff\x7f", 8), 1),
            "the file claims 2147483647 meshes and is too short for that");
  std::string astray = file_of(4, {Content{}.bytes<float>(), Content{}.bytes<float>()});
  astray[astray.size() - 6] = '\x7f';
  EXPECT_EQ(error(astray, 1), "mesh 1 stands beyond the end of the file");
  EXPECT_EQ(error(std::string("\x1c\x04\x04\0rubbish", 11)),
            "the mesh's data are damaged: they cannot be decompressed");
  std::string flipped = good;
  flipped[20] = static_cast<char>(flipped[20] ^ 0x55);
  EXPECT_NE(error(flipped), "no error");
}

TEST_F(Serialized, TruncatedFilesAndHugeClaimsAreRefused) {
  const std::string whole = Content{4, 0x1003}.bytes<float>();
  for (size_t size = 0; size < whole.size(); size += 7)
    EXPECT_EQ(error(file_of(4, {whole.substr(0, size)})), "the mesh's data end too early") << size;
  const std::string good = file_of(4, {whole});
  for (size_t size = 4; size + 30 < good.size(); size += 5)
    EXPECT_EQ(error(good.substr(0, size)), "the mesh's data end too early") << size;
  for (const uint64_t claim : {uint64_t{1} << 30, (uint64_t{1} << 31) - 1}) {
    const Content vertices{.vertices = claim}, triangles{.triangles = claim};
    EXPECT_EQ(error(file_of(4, {vertices.bytes<float>()})), "the mesh's data end too early");
    EXPECT_EQ(error(file_of(4, {triangles.bytes<float>()})), "the mesh's data end too early");
  }
  EXPECT_EQ(error(file_of(4, {Content{.vertices = ~uint64_t{0}}.bytes<float>()})),
            "18446744073709551615 vertices and 2 triangles are claimed: a mesh can have up to 2^31 - 1");
}

TEST_F(Serialized, RefusesIndicesOutOfRangeAndPositionsThatAreNotFinite) {
  std::string content = Content{}.bytes<float>();
  content.back() = 1;
  EXPECT_EQ(error(file_of(4, {content})), "a triangle refers to vertex 16777219, but there are 4");
  content = Content{3}.bytes<float>();
  content[20 + 3] = '\x7f', content[20 + 2] = '\x80';
  EXPECT_EQ(error(file_of(3, {content})), "a vertex position is not finite");
}
}  // namespace
}  // namespace turbid
