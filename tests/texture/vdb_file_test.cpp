// OpenVDB files: those of the library itself, and files of every kind of node content written here.
#include "texture/vdb_file.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <fstream>

#include "core/error.h"
#include "core/rng.h"
#include "testing/temporary_folder.h"
#include "texture/grid_volume.h"
#include "texture/openvdb_file.h"

namespace turbid {
namespace {

std::string unpacked(const std::string& base64) {
  std::string packed;
  uint32_t bits = 0;
  int count = 0;
  const std::string letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  for (const char c : base64) {
    if (c == '=') break;
    bits = bits << 6 | static_cast<uint32_t>(letters.find(c));
    if ((count += 6) >= 8) packed += static_cast<char>(bits >> (count -= 8) & 0xff);
  }
  std::string out(1 << 17, '\0');
  z_stream stream{};
  inflateInit2(&stream, 16 + MAX_WBITS);
  stream.next_in = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_in = static_cast<uInt>(packed.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  EXPECT_EQ(inflate(&stream, Z_FINISH), Z_STREAM_END);
  out.resize(stream.total_out);
  inflateEnd(&stream);
  return out;
}

class VdbFile : public ::testing::Test {
 protected:
  std::string write(const std::string& bytes) const {
    const std::string path = folder_.file("test.vdb");
    std::ofstream(path, std::ios::binary) << bytes;
    return path;
  }
  GridVolume volume(const std::string& bytes, const std::string& grid) const {
    VdbGrid read = read_vdb(write(bytes), grid);
    return {std::move(read.voxels), {.to_world = read.to_world}};
  }
  std::string error_of(const std::string& bytes, const std::string& grid = "density") const {
    try {
      read_vdb(write(bytes), grid);
    } catch (const FileError& error) {
      return error.what() + folder_.file("test.vdb").size() + 2;
    }
    return "no error";
  }

  const testing::TemporaryFolder folder_;
  const std::string real_ = unpacked(testing::kOpenVdbFile);
};

TEST_F(VdbFile, OfTheLibraryItselfIsRead) {
  const GridVolume density = volume(real_, "density");
  for (int i = 0; i < 12; ++i) {
    const auto f = static_cast<float>(i);
    EXPECT_EQ(density.eval(0.25f * Vec3(f, 2 * f, -f)), Spectrum(1 + f)) << i;
  }
  EXPECT_EQ(density.eval(0.25f * Vec3(20, 17, 22.5f)), Spectrum(2.5f)) << "a tile";
  EXPECT_EQ(density.eval(0.25f * Vec3(15.5f, 20, 20)), Spectrum(1.25f)) << "half-way to the background";
  EXPECT_EQ(density.eval(0.25f * Vec3(5, 5, 5)), Spectrum(0.0f));
  EXPECT_EQ(density.range(density.bounds()).max, Spectrum(12.0f));

  const GridVolume temperature = volume(real_, "temperature");
  EXPECT_EQ(temperature.voxels().format(), VoxelFormat::kHalf);
  // The library's own answers to where these voxels stand.
  EXPECT_NEAR(temperature.eval({0, 2.25f, 3.375f})[0], 1500, 0.1f);
  EXPECT_NEAR(temperature.eval({2, 1.75f, 2.625f})[0], 900, 0.1f);
  EXPECT_NEAR(temperature.eval({1, 2, 3})[0], 300, 0.1f);

  const GridVolume color = volume(real_, "color");
  EXPECT_EQ(color.voxels().channels(), 3);
  EXPECT_EQ(color.eval(Vec3(0)), Spectrum(0.1f, 0.2f, 0.3f));
  EXPECT_NEAR(color.eval({1, 0, 0})[2], 0.15f, 1e-6f);
}

// --- Files written here
// -----------------------------------------------------------------------------------------------

struct Writer {
  std::string bytes;
  template <class T>
  void put(T v) {
    bytes.append(reinterpret_cast<const char*>(&v), sizeof(v));
  }
  void text(const std::string& s) {
    put(static_cast<uint32_t>(s.size()));
    bytes += s;
  }
  void set(size_t at, int64_t v) { std::memcpy(bytes.data() + at, &v, sizeof(v)); }
};

/// A grid with background 3 and one leaf at the origin, of whose voxels the even ones are active.
struct Recipe {
  uint8_t content = 0;             ///< how the leaf stores its inactive values
  std::vector<float> others = {};  ///< the values that the content names
  uint32_t compression = 2;        ///< active mask only
  std::string type = "Tree_float_5_4_3";
  std::string map = "UniformScaleMap";
  uint32_t version = 224;
  char offsets = 1;
  int32_t origin = 0;
};

void put_inner(Writer& w, int slots, bool all_values) {
  const size_t bits = static_cast<size_t>(slots * slots * slots);
  std::string mask(bits / 8, '\0');
  w.bytes += mask;
  w.bytes[w.bytes.size() - bits / 8] = 1;  // a child in the first slot
  w.bytes += mask;                         // nothing active
  w.put(uint8_t{0});                       // all else is background
  for (size_t i = 0; all_values && i < bits; ++i) w.put(3.0f);
}

std::string make_file(const Recipe& r, bool instance = false) {
  Writer w;
  w.put(int64_t{0x56444220});
  w.put(r.version);
  w.put(uint32_t{10}), w.put(uint32_t{0});
  w.put(r.offsets);
  w.bytes += std::string(36, 'u');
  w.put(uint32_t{1});
  w.text("creator"), w.text("string"), w.text("a test");
  w.put(uint32_t{instance ? 2u : 1u});
  const auto descriptor = [&](const std::string& name, const std::string& parent) {
    w.text(name), w.text(r.type), w.text(parent);
    const size_t offsets = w.bytes.size();
    for (int i = 0; i < 3; ++i) w.put(int64_t{0});
    w.set(offsets, static_cast<int64_t>(w.bytes.size()));
    w.put(r.compression);
    w.put(uint32_t{0});  // no metadata
    w.text(r.map);
    return offsets;
  };
  const auto scale_map = [&] {
    for (int i = 0; i < 15; ++i) w.put(i < 3 ? 2.0 : 7.0);
  };
  const size_t offsets = descriptor("density", "");
  scale_map();
  w.put(int32_t{1});
  w.put(3.0f);
  w.put(uint32_t{0}), w.put(uint32_t{1});
  for (int i = 0; i < 3; ++i) w.put(r.origin);
  put_inner(w, 32, !(r.compression & 2));
  put_inner(w, 16, !(r.compression & 2));
  const std::string active(64, 0x55);
  w.bytes += active;
  w.bytes += active;
  w.put(r.content);
  for (const float v : r.others) w.put(v);
  if (r.content >= 3 && r.content <= 5) w.bytes += std::string(64, 0x0f);  // choice: the lower four of eight
  const bool all = r.content == 6 || !(r.compression & 2);
  for (int i = 0; i < 512; ++i)
    if (all || i % 2 == 0) w.put(static_cast<float>(100 + i));
  w.set(offsets + 16, static_cast<int64_t>(w.bytes.size()));
  if (instance) {
    const size_t second = descriptor(
        "twin\x1e"
        "1",
        "density");
    for (int i = 0; i < 15; ++i) w.put(i < 3 ? 4.0 : 7.0);
    w.set(second + 16, static_cast<int64_t>(w.bytes.size()));
  }
  return w.bytes;
}

/// Voxel i of the leaf: z fastest.
float voxel(const GridVolume& volume, int i) {
  return volume.eval(2.0f *
                     Vec3(static_cast<float>(i / 64), static_cast<float>(i / 8 % 8), static_cast<float>(i % 8)))[0];
}

TEST_F(VdbFile, EveryContentOfANodeIsRead) {
  struct Case {
    uint8_t content;
    std::vector<float> others;
    float low, high;  ///< inactive voxels where the choice is 1 (i % 8 < 4) and 0
  };
  for (const Case& c : {Case{0, {}, 3, 3}, Case{1, {}, -3, -3}, Case{2, {9}, 9, 9}, Case{3, {}, 3, -3},
                        Case{4, {9}, 3, 9}, Case{5, {9, 8}, 8, 9}}) {
    const GridVolume v = volume(make_file({.content = c.content, .others = c.others}), "density");
    for (const int i : {0, 2, 66, 508, 510})
      EXPECT_EQ(voxel(v, i), static_cast<float>(100 + i)) << "content " << int(c.content);
    for (const int i : {1, 67, 507}) EXPECT_EQ(voxel(v, i), c.low) << "content " << int(c.content);
    for (const int i : {5, 511}) EXPECT_EQ(voxel(v, i), i % 8 < 4 ? c.low : c.high) << "content " << int(c.content);
    EXPECT_EQ(v.eval(Vec3(-4))[0], 3) << "background around";
  }
  for (const uint32_t compression : {0u, 2u}) {
    const GridVolume v = volume(make_file({.content = 6, .compression = compression}), "density");
    for (int i = 0; i < 512; ++i) EXPECT_EQ(voxel(v, i), static_cast<float>(100 + i));
  }
}

TEST_F(VdbFile, GridsMayShareATree) {
  const std::string file = make_file({}, true);
  EXPECT_EQ(volume(file, "twin").eval(4.0f * Vec3(0, 0, 2))[0], 102);
  EXPECT_EQ(volume(file, "density").eval(2.0f * Vec3(0, 0, 2))[0], 102);
}

TEST_F(VdbFile, WhatIsWrongIsSaid) {
  EXPECT_EQ(error_of(""), "not an OpenVDB file");
  EXPECT_EQ(error_of("VOL"), "not an OpenVDB file");
  EXPECT_EQ(error_of(std::string(100, 'x')), "not an OpenVDB file");
  EXPECT_EQ(error_of(make_file({.version = 220})),
            "version 220 of the OpenVDB format is not supported: 222 to 224 are");
  EXPECT_EQ(error_of(make_file({.offsets = 0})), "OpenVDB streams without grid offsets are not supported");
  EXPECT_EQ(error_of(make_file({.type = "Tree_double_5_4_3"})),
            "grid 'density' is of type 'Tree_double_5_4_3': only float and vec3s grids are supported");
  EXPECT_EQ(error_of(make_file({.map = "NonlinearFrustumMap"})),
            "a transform of type 'NonlinearFrustumMap' is not supported");
  EXPECT_EQ(error_of(make_file({.content = 7})), "damaged: unknown content 7 of a node");
  EXPECT_EQ(error_of(make_file({.origin = 8})), "damaged: a node stands at 8");
  EXPECT_EQ(error_of(real_, "smoke"), "has no grid 'smoke', but 'color', 'density', 'temperature'");
  EXPECT_EQ(error_of(make_file({}).substr(0, 9000)), "the file ends too early");
}

TEST_F(VdbFile, DamagedFilesAreRefusedOrRead) {
  Rng rng(5);
  const auto survives = [&](const std::string& bytes) {
    for (const char* grid : {"density", "temperature", "color"}) {
      try {
        read_vdb(write(bytes), grid);
      } catch (const FileError&) {
      }
    }
  };
  for (int i = 0; i < 60; ++i) survives(real_.substr(0, static_cast<size_t>(i * i) * real_.size() / 3600));
  for (int i = 0; i < 150; ++i) {
    std::string bytes = real_;
    // Most of the file is zeros: half of the damage goes where its structure is.
    const size_t reach = i % 2 ? bytes.size() : 1500;
    bytes[rng.next_u32() % reach] ^= static_cast<char>(1u << (rng.next_u32() % 8));
    survives(bytes);
  }
}

}  // namespace
}  // namespace turbid
