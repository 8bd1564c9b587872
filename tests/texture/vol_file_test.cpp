// Mitsuba's .vol grids: what is stored comes back, what is wrong is said.
#include "texture/vol_file.h"

#include <gtest/gtest.h>

#include <cstring>
#include <fstream>

#include "core/error.h"
#include "testing/temporary_folder.h"

namespace turbid {
namespace {

struct Header {
  char magic[3] = {'V', 'O', 'L'};
  uint8_t version = 3;
  int32_t encoding = 1;
  int32_t size[3] = {3, 2, 9};
  int32_t channels = 1;
  float box[6] = {-1, -2, -3, 1, 2, 3};
};
static_assert(sizeof(Header) == 48);

template <class T>
std::string make_file(const Header& header, const std::vector<T>& values) {
  std::string bytes(sizeof(header) + values.size() * sizeof(T), '\0');
  std::memcpy(bytes.data(), &header, sizeof(header));
  if (!values.empty()) std::memcpy(bytes.data() + sizeof(header), values.data(), values.size() * sizeof(T));
  return bytes;
}

class VolFileTest : public ::testing::Test {
 protected:
  VolFile read(const std::string& bytes) const {
    std::ofstream(folder_.file("test.vol"), std::ios::binary) << bytes;
    return read_vol(folder_.file("test.vol"));
  }
  std::string error_of(const std::string& bytes) const {
    try {
      read(bytes);
    } catch (const FileError& error) {
      return error.what() + folder_.file("test.vol").size() + 2;
    }
    return "no error";
  }

  const testing::TemporaryFolder folder_;
};

std::vector<float> ramp(size_t n) {
  std::vector<float> values(n);
  for (size_t i = 0; i < n; ++i) values[i] = static_cast<float>(i) / 8;
  return values;
}

TEST_F(VolFileTest, FloatsComeBack) {
  const VolFile file = read(make_file(Header{}, ramp(54)));
  EXPECT_EQ(file.voxels.size(), (Voxel{3, 2, 9}));
  EXPECT_EQ(file.voxels.format(), VoxelFormat::kFloat);
  EXPECT_EQ(file.box.min, Vec3(-1, -2, -3));
  EXPECT_EQ(file.box.max, Vec3(1, 2, 3));
  for (int z = 0; z < 9; ++z)
    for (int y = 0; y < 2; ++y)
      for (int x = 0; x < 3; ++x)
        EXPECT_EQ(file.voxels.at(x, y, z), Spectrum(static_cast<float>((z * 2 + y) * 3 + x) / 8));
}

TEST_F(VolFileTest, ThreeChannelsComeBack) {
  const VolFile file = read(make_file(Header{.channels = 3}, ramp(162)));
  EXPECT_EQ(file.voxels.channels(), 3);
  EXPECT_EQ(file.voxels.at(2, 1, 8), Spectrum(159 / 8.0f, 160 / 8.0f, 161 / 8.0f));
}

TEST_F(VolFileTest, HalvesAndBytesComeBack) {
  std::vector<uint16_t> halves;
  std::vector<uint8_t> bytes;
  for (int i = 0; i < 54; ++i) {
    halves.push_back(Imath::half(static_cast<float>(i) / 8).bits());
    bytes.push_back(static_cast<uint8_t>(i * 4));
  }
  const VolFile half = read(make_file(Header{.encoding = 2}, halves));
  EXPECT_EQ(half.voxels.format(), VoxelFormat::kHalf);
  EXPECT_EQ(half.voxels.at(1, 1, 3), Spectrum(22 / 8.0f));
  EXPECT_FLOAT_EQ(read(make_file(Header{.encoding = 3}, bytes)).voxels.at(1, 1, 3)[0], 88 / 255.0f);
}

TEST_F(VolFileTest, WhatIsWrongIsSaid) {
  const std::vector<float> values = ramp(54);
  EXPECT_EQ(error_of(""), "not a Mitsuba grid: such files begin with 'VOL'");
  EXPECT_EQ(error_of("P6 a picture, not a grid"), "not a Mitsuba grid: such files begin with 'VOL'");
  EXPECT_EQ(error_of(make_file(Header{.version = 2}, values)),
            "version 2 of the grid format is not supported: only 3 is");
  EXPECT_EQ(error_of(make_file(Header{.encoding = 4}, values)),
            "encoding 4 is not supported: 1 (float32), 2 (float16) and 3 (uint8) are");
  EXPECT_EQ(error_of(make_file(Header{.channels = 6}, values)),
            "grids with 6 channels are not supported: only 1 and 3 are");
  EXPECT_EQ(error_of(make_file(Header{.size = {0, 2, 9}}, values)), "the grid has 0 cells along an axis");
  EXPECT_EQ(error_of(make_file(Header{.size = {3, -2, 9}}, values)), "the grid has -2 cells along an axis");
  EXPECT_EQ(error_of(make_file(Header{}, values).substr(0, 30)), "the file ends too early");
  EXPECT_EQ(error_of(make_file(Header{}, ramp(53))), "the file ends too early for 3 x 2 x 9 cells with 1 channel(s)");
  // Sizes whose product overflows 32 and 64 bits.
  EXPECT_EQ(error_of(make_file(Header{.size = {65536, 65536, 1}}, values)),
            "the file ends too early for 65536 x 65536 x 1 cells with 1 channel(s)");
  EXPECT_EQ(error_of(make_file(Header{.size = {2147483647, 2147483647, 2147483647}}, values)),
            "the file ends too early for 2147483647 x 2147483647 x 2147483647 cells with 1 channel(s)");
  std::vector<float> bad = values;
  bad[7] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(error_of(make_file(Header{}, bad)), "a grid holds a value that is not a finite number");
  EXPECT_THROW(read_vol(folder_.file("missing.vol")), FileError);
  EXPECT_THROW(read_vol(folder_.path().string()), FileError);
}

}  // namespace
}  // namespace turbid
