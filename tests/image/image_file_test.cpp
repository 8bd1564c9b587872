#include "image/image_file.h"

#include <Imath/half.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfTiledOutputFile.h>
#include <gtest/gtest.h>
#define STBI_WRITE_NO_STDIO
#include <stb/stb_image_write.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>

#include "core/error.h"
#include "core/rng.h"
#include "image/atomic_file.h"
#include "image/color.h"
#include "image/tone_map.h"
#include "testing/temporary_folder.h"

namespace turbid {
namespace {

namespace fs = std::filesystem;
using testing::TemporaryFolder;

Image noise_image(int width, int height, std::vector<std::string> names) {
  Image image(width, height, std::move(names));
  Rng rng(7);
  for (size_t c = 0; c < image.channel_count(); ++c)
    for (float& v : image.channel(c)) v = (rng.next_float() - 0.25f) * std::exp2(40 * rng.next_float() - 20);
  return image;
}

void expect_same_pixels(const Image& a, const Image& b) {
  ASSERT_EQ(a.channel_names(), b.channel_names());
  ASSERT_EQ(a.width(), b.width());
  ASSERT_EQ(a.height(), b.height());
  for (size_t c = 0; c < a.channel_count(); ++c)
    for (size_t i = 0; i < a.pixel_count(); ++i) ASSERT_EQ(a.channel(c)[i], b.channel(c)[i]) << c << " " << i;
}

/// The message of the FileError that reading throws; empty when it does not.
std::string reading_error(const std::string& path) {
  try {
    read_image(path);
  } catch (const FileError& error) {
    EXPECT_EQ(error.exit_code(), 4);
    EXPECT_TRUE(std::string(error.what()).starts_with(path + ": ")) << error.what();
    return error.what();
  }
  return {};
}

void write_bytes(const std::string& path, const std::string& bytes) { std::ofstream(path, std::ios::binary) << bytes; }

TEST(Exr, KeepsEveryBitOfNamedLayersAndTheMetadata) {
  const TemporaryFolder folder;
  Image image = noise_image(37, 23, {"R", "G", "B", "A", "m2_path.X", "m2_path.Y"});
  image.channel("R")[3] = kInfinity;
  image.metadata = {{"scene", "candle.xml"}, {"command", "turbid render 'a b'"}, {"seed", "18446744073709551615"}};
  write_exr(folder.file("a.exr"), image);
  const Image back = read_image(folder.file("a.exr"));
  expect_same_pixels(image, back);
  for (const auto& [name, value] : image.metadata) EXPECT_EQ(back.metadata.at(name), value);
}

TEST(Exr, KeepsTheCropWindow) {
  const TemporaryFolder folder;
  Image image = noise_image(5, 4, {"R", "G", "B"});
  image.offset = {10, 20};
  image.full_size = {64, 32};
  write_exr(folder.file("a.exr"), image);
  const Image back = read_image(folder.file("a.exr"));
  expect_same_pixels(image, back);
  EXPECT_EQ(back.offset, Vec2i(10, 20));
  EXPECT_EQ(back.full_size, Vec2i(64, 32));
}

TEST(Exr, ReadsSomeChannelsInTheOrderAskedFor) {
  const TemporaryFolder folder;
  const Image image = noise_image(8, 8, {"R", "G", "B", "depth.Z"});
  write_exr(folder.file("a.exr"), image);
  const Image some = read_exr(folder.file("a.exr"), {"depth.Z", "G"});
  EXPECT_EQ(some.channel_names(), (std::vector<std::string>{"depth.Z", "G"}));
  EXPECT_EQ(some.channel("G")[11], image.channel("G")[11]);
  EXPECT_EQ(some.channel("depth.Z")[12], image.channel("depth.Z")[12]);
  try {
    read_exr(folder.file("a.exr"), {"Q"});
    FAIL();
  } catch (const FileError& error) {
    EXPECT_EQ(error.what(), folder.file("a.exr") + ": has no channel 'Q'");
  }
}

TEST(Exr, ReadsHalfUintAndCoarseChannelsOfOddWindows) {
  const TemporaryFolder folder;
  const Imath::Box2i window(Vec2i(-4, 2), Vec2i(3, 5));  // 8 x 4
  Imf::Header header(window, window);
  header.channels().insert("Y", Imf::Channel(Imf::HALF));
  header.channels().insert("id", Imf::Channel(Imf::UINT));
  header.channels().insert("C", Imf::Channel(Imf::FLOAT, 2, 2));
  std::vector<half> y(32);
  std::vector<uint32_t> id(32);
  std::vector<float> coarse(8);
  for (size_t i = 0; i < 32; ++i) y[i] = half(0.25f * static_cast<float>(i)), id[i] = static_cast<uint32_t>(1000 * i);
  for (size_t i = 0; i < 8; ++i) coarse[i] = static_cast<float>(i);
  {
    Imf::OutputFile file(folder.file("a.exr").c_str(), header);
    Imf::FrameBuffer frame;
    frame.insert("Y", Imf::Slice::Make(Imf::HALF, y.data(), window));
    frame.insert("id", Imf::Slice::Make(Imf::UINT, id.data(), window));
    frame.insert("C", Imf::Slice::Make(Imf::FLOAT, coarse.data(), window, 0, 0, 2, 2));
    file.setFrameBuffer(frame);
    file.writePixels(4);
  }
  const Image image = read_image(folder.file("a.exr"));
  EXPECT_EQ(image.width(), 8);
  EXPECT_EQ(image.height(), 4);
  for (size_t i = 0; i < 32; ++i) {
    EXPECT_EQ(image.channel("Y")[i], 0.25f * static_cast<float>(i));
    EXPECT_EQ(image.channel("id")[i], static_cast<float>(1000 * i));
    EXPECT_EQ(image.channel("C")[i], static_cast<float>((i / 16) * 4 + (i % 8) / 2));
  }
}

TEST(Exr, ReadsTiledFiles) {
  const TemporaryFolder folder;
  const Image image = noise_image(21, 13, {"R", "G", "B"});
  Imf::Header header(21, 13);
  header.setTileDescription(Imf::TileDescription(8, 8, Imf::ONE_LEVEL));
  Imf::FrameBuffer frame;
  for (const std::string& name : image.channel_names()) {
    header.channels().insert(name, Imf::Channel(Imf::FLOAT));
    frame.insert(name, Imf::Slice::Make(Imf::FLOAT, image.channel(name).data(), header.dataWindow()));
  }
  {
    Imf::TiledOutputFile file(folder.file("a.exr").c_str(), header);
    file.setFrameBuffer(frame);
    file.writeTiles(0, file.numXTiles() - 1, 0, file.numYTiles() - 1);
  }
  expect_same_pixels(read_image(folder.file("a.exr")), image);
}

TEST(Exr, DamagedFilesAreFileErrors) {
  const TemporaryFolder folder;
  write_exr(folder.file("good.exr"), noise_image(40, 40, {"R", "G", "B"}));
  const std::string good = read_file(folder.file("good.exr"));
  const std::string path = folder.file("bad.exr");
  for (const size_t length :
       {size_t{4}, size_t{9}, size_t{60}, size_t{200}, size_t{400}, good.size() / 2, good.size() - 1}) {
    write_bytes(path, good.substr(0, length));
    EXPECT_NE(reading_error(path), "") << "cut at " << length;
  }
  // A flipped bit may go unnoticed in pixels, but it must never crash or be another kind of exception.
  Rng rng(3);
  for (int i = 0; i < 300; ++i) {
    std::string bad = good;
    const size_t place = rng.next_u32() % std::min<size_t>(bad.size(), 600);
    bad[place] = static_cast<char>(rng.next_u32());
    write_bytes(path, bad);
    EXPECT_NO_THROW(reading_error(path));
  }
}

TEST(Exr, AHeaderThatClaimsTerabytesIsRefusedBeforeAnyMemoryIsTaken) {
  const TemporaryFolder folder;
  write_exr(folder.file("a.exr"), noise_image(4, 4, {"R"}));
  std::string bytes = read_file(folder.file("a.exr"));
  const size_t window = bytes.find("dataWindow") + std::string("dataWindow").size() + 1 + 6 + 4;  // "box2i", size
  for (const size_t at : {window + 8, window + 12})
    for (size_t i = 0; i < 4; ++i) bytes[at + i] = static_cast<char>(i < 3 ? 0xff : 0x00);  // max x, y = 2^24 - 1
  write_bytes(folder.file("a.exr"), bytes);
  EXPECT_NE(reading_error(folder.file("a.exr")), "");
}

TEST(ImageFile, MissingEmptyAndForeignFilesSaySo) {
  const TemporaryFolder folder;
  EXPECT_EQ(reading_error(folder.file("none.png")),
            folder.file("none.png") + ": cannot be opened: No such file or directory");
  EXPECT_EQ(reading_error(folder.path().string()), folder.path().string() + ": is a folder, not a file");
  write_bytes(folder.file("empty.exr"), "");
  EXPECT_EQ(reading_error(folder.file("empty.exr")), folder.file("empty.exr") + ": is empty");
  write_bytes(folder.file("text.png"), "this is no picture");
  EXPECT_NE(reading_error(folder.file("text.png")).find("not a readable picture"), std::string::npos);
}

void collect(void* context, void* data, int size) {
  static_cast<std::string*>(context)->append(static_cast<const char*>(data), static_cast<size_t>(size));
}

TEST(ImageFile, EightBitFilesAreDecodedAsColourOrAsData) {
  const TemporaryFolder folder;
  const std::vector<unsigned char> pixels{0, 128, 255, 64, 10, 20, 30, 255};  // two RGBA pixels
  std::string png, bmp, tga, jpg;
  stbi_write_png_to_func(collect, &png, 2, 1, 4, pixels.data(), 8);
  stbi_write_bmp_to_func(collect, &bmp, 2, 1, 4, pixels.data());
  stbi_write_tga_to_func(collect, &tga, 2, 1, 4, pixels.data());
  stbi_write_jpg_to_func(collect, &jpg, 2, 1, 4, pixels.data(), 100);
  for (const auto& [name, bytes] : {std::pair("a.png", png), {"a.bmp", bmp}, {"a.tga", tga}}) {
    write_bytes(folder.file(name), bytes);
    const Image color = read_image(folder.file(name));
    EXPECT_NEAR(color.channel("G")[0], 0.215861f, 1e-6f) << name;  // sRGB 128
    EXPECT_EQ(color.channel("B")[0], 1.0f);
    EXPECT_EQ(color.channel("A")[0], 64 / 255.0f) << name;
    const Image data = read_image(folder.file(name), PixelEncoding::kData);
    EXPECT_EQ(data.channel("G")[0], 128 / 255.0f) << name;
  }
  write_bytes(folder.file("a.jpg"), jpg);
  EXPECT_EQ(read_image(folder.file("a.jpg")).channel_names(), (std::vector<std::string>{"R", "G", "B"}));
}

TEST(ImageFile, DamagedEightBitFilesAreFileErrorsOrPictures) {
  const TemporaryFolder folder;
  std::vector<unsigned char> pixels(32 * 32 * 3);
  Rng rng(4);
  for (unsigned char& v : pixels) v = static_cast<unsigned char>(rng.next_u32());
  std::string files[4];
  stbi_write_png_to_func(collect, &files[0], 32, 32, 3, pixels.data(), 96);
  stbi_write_bmp_to_func(collect, &files[1], 32, 32, 3, pixels.data());
  stbi_write_tga_to_func(collect, &files[2], 32, 32, 3, pixels.data());
  stbi_write_jpg_to_func(collect, &files[3], 32, 32, 3, pixels.data(), 90);
  const std::string path = folder.file("bad");
  for (const std::string& good : files) {
    for (size_t length = 0; length < good.size(); length += 1 + length / 3) {
      write_bytes(path, good.substr(0, length));
      EXPECT_NO_THROW(reading_error(path));
    }
    for (int i = 0; i < 100; ++i) {
      std::string bad = good;
      // The header's sizes are left alone: a picture of gigabytes is slow, not wrong.
      const size_t place = 24 + rng.next_u32() % (bad.size() - 24);
      bad[place] = static_cast<char>(rng.next_u32());
      write_bytes(path, bad);
      EXPECT_NO_THROW(reading_error(path));
    }
  }
}

TEST(ImageFile, AJpegWithAnImpossibleHuffmanTableIsRefused) {
  const TemporaryFolder folder;
  const unsigned char pixels[3] = {1, 2, 3};
  std::string bytes;
  stbi_write_jpg_to_func(collect, &bytes, 1, 1, 3, pixels, 90);
  const size_t tables = bytes.find("\xff\xc4");
  ASSERT_NE(tables, std::string::npos);
  bytes[tables + 5] = bytes[tables + 6] = '\xff';  // 510 codes of one and two bits
  write_bytes(folder.file("a.jpg"), bytes);
  EXPECT_EQ(reading_error(folder.file("a.jpg")),
            folder.file("a.jpg") + ": is a damaged JPEG file: impossible Huffman table");
}

TEST(ImageFile, GreyAndHighDynamicRangeFiles) {
  const TemporaryFolder folder;
  const unsigned char grey[2] = {0, 255};
  std::string png;
  stbi_write_png_to_func(collect, &png, 2, 1, 1, grey, 2);
  write_bytes(folder.file("a.png"), png);
  // Two pixels of mantissas and a common exponent: 200/256 2^7 = 100, 128/256 2^0 = 0.5.
  write_bytes(folder.file("a.hdr"),
              "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n\xc8\x64\x32\x87\x80\x40\x20\x80");
  EXPECT_EQ(read_image(folder.file("a.png")).channel_names(), (std::vector<std::string>{"Y"}));
  const Image image = read_image(folder.file("a.hdr"));
  EXPECT_NEAR(image.channel("R")[0], 100, 0.5);
  EXPECT_NEAR(image.channel("B")[1], 0.125, 0.001);
}

TEST(Png, FollowsTheDocumentedCurve) {
  const TemporaryFolder folder;
  Image image(6, 1, {"R", "G", "B"});
  const float values[6] = {-1, 0.18f, 0.7f, 1, 4, kInfinity};
  for (size_t c = 0; c < 3; ++c) std::copy(values, values + 6, image.channel(c).begin());
  image.channel("B")[0] = std::numeric_limits<float>::quiet_NaN();
  write_png(folder.file("a.png"), image);
  const Image data = read_image(folder.file("a.png"), PixelEncoding::kData);
  const float expected[6] = {0, linear_to_srgb(0.18f), linear_to_srgb(0.7f), linear_to_srgb(0.889636f), 1, 1};
  for (size_t i = 0; i < 6; ++i) EXPECT_NEAR(data.channel("R")[i], expected[i], 0.51 / 255) << i;
  EXPECT_EQ(data.channel("B")[0], 0.0f);
  write_png(folder.file("b.png"), image, -2);  // two stops down: 4 * 2^-2 = 1
  EXPECT_NEAR(read_image(folder.file("b.png"), PixelEncoding::kData).channel("R")[4], expected[3], 0.51 / 255);
}

TEST(Png, DividesByAlpha) {
  const TemporaryFolder folder;
  Image image(1, 1, {"R", "G", "B", "A"});
  image.channel("R")[0] = 0.25f;
  image.channel("A")[0] = 0.5f;
  write_png(folder.file("a.png"), image);
  const Image back = read_image(folder.file("a.png"));
  EXPECT_NEAR(back.channel("R")[0], 0.5f, 0.005f);
  EXPECT_NEAR(back.channel("A")[0], 0.5f, 0.005f);
}

TEST(Color, CurvesAndMatricesAreInverses) {
  for (int i = 0; i <= 1000; ++i) {
    const float v = static_cast<float>(i) / 1000;
    EXPECT_NEAR(linear_to_srgb(srgb_to_linear(v)), v, 1e-5f);
  }
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      double sum = 0;
      for (int k = 0; k < 3; ++k) sum += kRgbToXyz[i][k] * kXyzToRgb[k][j];
      EXPECT_NEAR(sum, i == j ? 1 : 0, 2e-6);
    }
  }
  EXPECT_NEAR(tone_curve(kToneKnee + 1e-4f) - tone_curve(kToneKnee), 1e-4f, 1e-6f);
}

TEST(AtomicFile, ReplacesFollowsLinksKeepsPermissionsAndLeavesNothing) {
  const TemporaryFolder folder;
  const std::string path = folder.file("a");
  write_file_atomically(path, std::string("one"));
  ::chmod(path.c_str(), 0640);
  fs::create_symlink("a", folder.file("link"));
  write_file_atomically(folder.file("link"), std::string("two, longer"));
  EXPECT_EQ(read_file(path), "two, longer");
  EXPECT_TRUE(fs::is_symlink(folder.file("link")));
  EXPECT_EQ(fs::status(path).permissions(), fs::perms(0640));
  check_writable(path);
  check_writable(folder.file("new"));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator()), 2);
}

TEST(AtomicFile, AStaleOrBusyPartFileIsNoObstacle) {
  const TemporaryFolder folder;
  write_bytes(folder.file("a.part"), "left by a killed process, and longer than the new content");
  write_file_atomically(folder.file("a"), std::string("new"));
  EXPECT_EQ(read_file(folder.file("a")), "new");
  EXPECT_FALSE(fs::exists(folder.file("a.part")));
}

TEST(AtomicFile, WritesToDevicesWithoutReplacingThem) {
  write_file_atomically("/dev/null", std::string("gone"));
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

TEST(AtomicFile, SaysWhyItCannotWrite) {
  const TemporaryFolder folder;
  const std::string path = folder.file("no/such/folder.exr");
  for (const bool check : {true, false}) {
    try {
      check ? check_writable(path) : write_file_atomically(path, std::string("x"));
      FAIL();
    } catch (const FileError& error) {
      EXPECT_EQ(error.what(), path + ": cannot be written: No such file or directory");
    }
  }
  EXPECT_THROW(check_writable(folder.path().string()), FileError);
}

}  // namespace
}  // namespace turbid
