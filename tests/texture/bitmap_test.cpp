// Pictures as textures: known pixels, filters, wrapping, encodings.
#include "texture/bitmap.h"

#include <gtest/gtest.h>

#include <fstream>

#include "core/error.h"
#include "image/color.h"
#include "testing/temporary_folder.h"

namespace turbid {
namespace {

using testing::TemporaryFolder;

SurfacePoint at(float u, float v) {
  SurfacePoint point;
  point.uv = Vec2(u, v);
  return point;
}

/// 4 x 2 grey values 0 .. 7, row by row from the top.
Image ramp() {
  Image image(4, 2, {"Y"});
  for (size_t i = 0; i < 8; ++i) image.channel("Y")[i] = static_cast<float>(i);
  return image;
}

BitmapSettings with(BitmapFilter filter, BitmapWrap wrap) {
  BitmapSettings settings;
  settings.filter = filter;
  settings.wrap = wrap;
  return settings;
}

/// An uncompressed Targa file with these bytes, grey or red-green-blue, the first row on top.
void write_targa(const std::string& path, int width, int height, const std::vector<uint8_t>& bytes) {
  const bool colour = bytes.size() == 3 * static_cast<size_t>(width * height);
  std::vector<char> data(18, 0);
  data[2] = colour ? 2 : 3;
  data[12] = static_cast<char>(width);
  data[14] = static_cast<char>(height);
  data[16] = colour ? 24 : 8;
  data[17] = 0x20;
  for (size_t i = 0; i < bytes.size(); ++i)
    data.push_back(static_cast<char>(colour ? bytes[i - i % 3 + (2 - i % 3)] : bytes[i]));
  std::ofstream(path, std::ios::binary).write(data.data(), static_cast<std::streamsize>(data.size()));
}

TEST(Bitmap, PixelCentresAreExact) {
  for (const BitmapFilter filter : {BitmapFilter::kBilinear, BitmapFilter::kNearest}) {
    const BitmapTexture texture(ramp(), with(filter, BitmapWrap::kRepeat));
    for (int y = 0; y < 2; ++y)
      for (int x = 0; x < 4; ++x)
        EXPECT_EQ(texture.eval(at((static_cast<float>(x) + 0.5f) / 4, (static_cast<float>(y) + 0.5f) / 2)),
                  Spectrum(static_cast<float>(4 * y + x)));
  }
}

TEST(Bitmap, NearestIsConstantOverAPixel) {
  const BitmapTexture texture(ramp(), with(BitmapFilter::kNearest, BitmapWrap::kClamp));
  EXPECT_EQ(texture.eval_scalar(at(0.26f, 0.01f)), 1);
  EXPECT_EQ(texture.eval_scalar(at(0.49f, 0.49f)), 1);
  EXPECT_EQ(texture.eval_scalar(at(0.51f, 0.51f)), 6);
}

TEST(Bitmap, BilinearInterpolates) {
  const BitmapTexture texture(ramp(), with(BitmapFilter::kBilinear, BitmapWrap::kClamp));
  EXPECT_NEAR(texture.eval_scalar(at(0.25f, 0.25f)), 0.5f, 1e-6f);
  EXPECT_NEAR(texture.eval_scalar(at(0.5f, 0.5f)), (1 + 2 + 5 + 6) / 4.0f, 1e-6f);
  EXPECT_NEAR(texture.eval_scalar(at(0.125f + 0.0625f, 0.25f + 0.125f)), 0.25f + 0.25f * 4, 1e-6f);
}

TEST(Bitmap, WrapsBeyondTheEdges) {
  const float left = -0.125f, right = 1.125f, far = 2.375f, row = 0.25f;  // pixels -1, 4 and 9 of the first row
  const auto value = [&](BitmapWrap wrap, float u) {
    return BitmapTexture(ramp(), with(BitmapFilter::kBilinear, wrap)).eval_scalar(at(u, row));
  };
  EXPECT_EQ(value(BitmapWrap::kRepeat, left), 3);
  EXPECT_EQ(value(BitmapWrap::kRepeat, right), 0);
  EXPECT_EQ(value(BitmapWrap::kRepeat, far), 1);
  EXPECT_EQ(value(BitmapWrap::kClamp, left), 0);
  EXPECT_EQ(value(BitmapWrap::kClamp, right), 3);
  EXPECT_EQ(value(BitmapWrap::kClamp, far), 3);
  EXPECT_EQ(value(BitmapWrap::kMirror, left), 0);
  EXPECT_EQ(value(BitmapWrap::kMirror, right), 3);
  EXPECT_EQ(value(BitmapWrap::kMirror, far), 1);
  EXPECT_EQ(value(BitmapWrap::kMirror, -1.125f), 3);
  // At the very edge, half-way between the last pixel and what follows it.
  EXPECT_NEAR(value(BitmapWrap::kRepeat, 0), 1.5f, 1e-6f);
  EXPECT_NEAR(value(BitmapWrap::kClamp, 0), 0, 1e-6f);
}

TEST(Bitmap, FarAwayOrMissingCoordinatesStayFinite) {
  for (const BitmapWrap wrap : {BitmapWrap::kRepeat, BitmapWrap::kMirror, BitmapWrap::kClamp}) {
    const BitmapTexture texture(ramp(), with(BitmapFilter::kBilinear, wrap));
    for (const float u : {1e8f, -1e8f, 1e20f, kInfinity, std::nanf("")}) {
      const float v = texture.eval_scalar(at(u, 0.5f));
      EXPECT_TRUE(v >= 0 && v <= 7) << u;
    }
  }
}

TEST(Bitmap, TransformsUv) {
  BitmapSettings settings = with(BitmapFilter::kNearest, BitmapWrap::kRepeat);
  settings.to_uv = UvTransform(Transform::translate(0.25, 0.5, 0) * Transform::scale(2, 1, 1));
  const BitmapTexture texture(ramp(), settings);
  EXPECT_EQ(texture.eval_scalar(at(0.05f, 0.1f)), 5);  // (0.35, 0.6): second column, second row
}

TEST(Bitmap, VRunsDownFromTheFirstRow) {
  const BitmapTexture texture(ramp(), with(BitmapFilter::kNearest, BitmapWrap::kRepeat));
  EXPECT_EQ(texture.eval_scalar(at(0.1f, 0.1f)), 0);
  EXPECT_EQ(texture.eval_scalar(at(0.1f, 0.9f)), 4);
}

TEST(Bitmap, ReportsMeanAndMaximum) {
  Image image(2, 1, {"R", "G", "B"});
  image.channel("R")[0] = 1;
  image.channel("B")[1] = 5;
  const BitmapTexture texture(image, {});
  EXPECT_EQ(texture.mean(), Spectrum(0.5f, 0, 2.5f));
  EXPECT_EQ(texture.max(), 5);
  EXPECT_FALSE(texture.is_grey());
  EXPECT_EQ(texture.eval(at(0.25f, 0.5f)), Spectrum(1, 0, 0));
  EXPECT_NEAR(texture.eval_scalar(at(0.25f, 0.5f)), Spectrum(1, 0, 0).luminance(), 1e-7f);
}

/// All 256 values of an 8-bit file, exactly, in 256 bytes.
TEST(Bitmap, EightBitFilesAreExactAndSmall) {
  const TemporaryFolder folder;
  const std::string path = folder.file("picture.tga");
  std::vector<uint8_t> bytes(256);
  for (size_t i = 0; i < 256; ++i) bytes[i] = static_cast<uint8_t>(i);
  write_targa(path, 16, 16, bytes);
  BitmapSettings settings = with(BitmapFilter::kNearest, BitmapWrap::kClamp);
  const BitmapTexture colour(path, settings);
  settings.raw = true;
  const BitmapTexture raw(path, settings);
  EXPECT_EQ(colour.memory(), 256u);
  EXPECT_TRUE(colour.is_grey());
  for (int i = 0; i < 256; ++i) {
    const SurfacePoint point = at((static_cast<float>(i % 16) + 0.5f) / 16, (static_cast<float>(i / 16) + 0.5f) / 16);
    const float v = static_cast<float>(i) / 255;
    EXPECT_EQ(raw.eval_scalar(point), v) << i;
    EXPECT_EQ(colour.eval_scalar(point), srgb_to_linear(v)) << i;
  }
}

TEST(Bitmap, ColourFilesKeepTheirChannels) {
  const TemporaryFolder folder;
  const std::string path = folder.file("picture.tga");
  write_targa(path, 2, 1, {255, 0, 128, 0, 255, 64});
  const BitmapTexture texture(path, with(BitmapFilter::kNearest, BitmapWrap::kClamp));
  EXPECT_EQ(texture.memory(), 6u);
  EXPECT_EQ(texture.eval(at(0.25f, 0.5f)), Spectrum(1, 0, srgb_to_linear(128 / 255.0f)));
  EXPECT_EQ(texture.eval(at(0.75f, 0.5f)), Spectrum(0, 1, srgb_to_linear(64 / 255.0f)));
}

TEST(Bitmap, ColoursAreInterpolatedInLinearLight) {
  const TemporaryFolder folder;
  const std::string path = folder.file("picture.tga");
  write_targa(path, 2, 1, {0, 255});
  const BitmapTexture texture(path, with(BitmapFilter::kBilinear, BitmapWrap::kClamp));
  EXPECT_NEAR(texture.eval_scalar(at(0.5f, 0.5f)), 0.5f, 1e-6f);  // not the light of byte 128, 0.216
}

TEST(Bitmap, OpenExrStaysLinear) {
  const TemporaryFolder folder;
  const std::string path = folder.file("picture.exr");
  Image image(2, 1, {"R", "G", "B"});
  image.channel("R")[0] = 0.25f;
  image.channel("G")[1] = 40;
  write_exr(path, image);
  const BitmapTexture texture(path, with(BitmapFilter::kNearest, BitmapWrap::kClamp));
  EXPECT_EQ(texture.eval(at(0.25f, 0.5f)), Spectrum(0.25f, 0, 0));
  EXPECT_EQ(texture.eval(at(0.75f, 0.5f)), Spectrum(0, 40, 0));
}

TEST(Bitmap, MissingAndBrokenFilesAreErrors) {
  EXPECT_THROW(BitmapTexture("/nowhere/picture.png"), FileError);
  const TemporaryFolder folder;
  const std::string path = folder.file("picture.png");
  std::ofstream(path) << "this is no picture";
  EXPECT_THROW(BitmapTexture texture(path), FileError);
}

/// Bilinear interpolation has an exact slope between pixel centres; it follows to_uv.
TEST(Bitmap, GradientIsTheSlopeOfTheScalar) {
  BitmapSettings settings = with(BitmapFilter::kBilinear, BitmapWrap::kRepeat);
  settings.to_uv = UvTransform(Transform::rotate(0, 0, 1, 30) * Transform::scale(1.5, 0.7, 1));
  Image colours(4, 2, {"R", "G", "B"});
  for (size_t i = 0; i < 8; ++i) {
    colours.channel("R")[i] = static_cast<float>(i * i);
    colours.channel("G")[i] = static_cast<float>(i % 3);
    colours.channel("B")[i] = static_cast<float>(7 - i);
  }
  for (const Image& image : {ramp(), colours}) {
    const BitmapTexture texture(image, settings);
    for (const Vec2& uv : {Vec2(0.41f, 0.17f), Vec2(0.83f, 0.42f), Vec2(-0.62f, 0.55f)}) {
      constexpr float kStep = 1e-3f;  // stays within one cell at these points; the scalar is bilinear there
      const Vec2 gradient = texture.gradient(at(uv.x, uv.y));
      const float du = texture.eval_scalar(at(uv.x + kStep, uv.y)) - texture.eval_scalar(at(uv.x - kStep, uv.y));
      const float dv = texture.eval_scalar(at(uv.x, uv.y + kStep)) - texture.eval_scalar(at(uv.x, uv.y - kStep));
      EXPECT_NEAR(gradient.x, du / (2 * kStep), 2e-2f);
      EXPECT_NEAR(gradient.y, dv / (2 * kStep), 2e-2f);
      EXPECT_GT(std::abs(gradient.x) + std::abs(gradient.y), 0.1f);
    }
  }
  EXPECT_EQ(BitmapTexture(ramp(), with(BitmapFilter::kNearest, BitmapWrap::kRepeat)).gradient(at(0.4f, 0.2f)),
            Vec2(0, 0));
}

}  // namespace
}  // namespace turbid
