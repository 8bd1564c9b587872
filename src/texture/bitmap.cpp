#include "texture/bitmap.h"

#include <algorithm>
#include <fstream>

#include "core/error.h"
#include "image/color.h"

namespace turbid {
namespace {

/// Formats whose numbers are floats with a linear meaning: OpenEXR and Radiance RGBE, told by their first bytes.
bool holds_floats(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::array<unsigned char, 4> head{};
  file.read(reinterpret_cast<char*>(head.data()), 4);
  const bool exr = head == std::array<unsigned char, 4>{0x76, 0x2f, 0x31, 0x01};
  return exr || (head[0] == '#' && head[1] == '?');
}

/// True when v is k/255 for a whole k, up to rounding: the file had 8 bits. 16-bit values k/65535 with this property
/// are those with k = 257 n, which 8 bits hold exactly.
bool is_byte(float v) {
  const float scaled = v * 255;
  return scaled >= 0 && scaled <= 255 && std::abs(scaled - std::round(scaled)) < 1e-3f;
}

/// Far outside, pixel numbers would overflow an int and neighbours coincide in float: there the texture means nothing.
constexpr float kFar = 1e9f;

}  // namespace

BitmapTexture::BitmapTexture(const std::string& path, const BitmapSettings& settings) : settings_(settings) {
  if (holds_floats(path)) {
    store(read_image(path), path, false);
  } else {
    store(read_image(path, PixelEncoding::kData), path, true);
  }
  summarise();
}

BitmapTexture::BitmapTexture(const Image& image, const BitmapSettings& settings, const std::string& name)
    : settings_(settings) {
  store(image, name, false);
  summarise();
}

void BitmapTexture::store(const Image& image, const std::string& name, bool encoded) {
  width_ = image.width();
  height_ = image.height();
  if (image.pixel_count() == 0) throw FileError(name, "the picture has no pixels");
  std::vector<std::span<const float>> sources = color_channels(image, name);
  channels_ = image.has_all({"R", "G", "B"}) ? 3 : 1;
  sources.resize(channels_);
  const bool bytes = encoded && std::all_of(sources.begin(), sources.end(), [](std::span<const float> source) {
                       return std::all_of(source.begin(), source.end(), is_byte);
                     });
  const auto linear = [&](float v) { return encoded && !settings_.raw ? srgb_to_linear(v) : v; };
  for (size_t i = 0; i < 256; ++i) decode_[i] = linear(static_cast<float>(i) / 255);

  const size_t n = image.pixel_count();
  if (bytes) {
    bytes_.resize(n * channels_);
    for (size_t i = 0; i < n * channels_; ++i)
      bytes_[i] = static_cast<uint8_t>(std::lround(sources[i % channels_][i / channels_] * 255));
  } else {
    floats_.resize(n * channels_);
    for (size_t i = 0; i < n * channels_; ++i) floats_[i] = linear(sources[i % channels_][i / channels_]);
  }
}

void BitmapTexture::summarise() {
  std::array<double, kChannels> sum{};
  max_ = value(0);
  const size_t n = static_cast<size_t>(width_) * static_cast<size_t>(height_);
  for (size_t i = 0; i < n * channels_; ++i) {
    const float v = value(i);
    sum[i % channels_] += double(v);
    max_ = std::max(max_, v);
  }
  for (size_t c = 0; c < kChannels; ++c)
    mean_[static_cast<int>(c)] = static_cast<float>(sum[channels_ == 1 ? 0 : c] / static_cast<double>(n));
}

size_t BitmapTexture::memory() const { return bytes_.size() + floats_.size() * sizeof(float); }

int BitmapTexture::wrap(int i, int n) const {
  if (i >= 0 && i < n) return i;
  switch (settings_.wrap) {
    case BitmapWrap::kClamp:
      return std::clamp(i, 0, n - 1);
    case BitmapWrap::kRepeat: {
      const int r = i % n;
      return r < 0 ? r + n : r;
    }
    case BitmapWrap::kMirror: {
      int r = i % (2 * n);
      if (r < 0) r += 2 * n;
      return r < n ? r : 2 * n - 1 - r;
    }
  }
  return 0;
}

Spectrum BitmapTexture::pixel(int x, int y) const {
  const size_t i =
      static_cast<size_t>(wrap(y, height_)) * static_cast<size_t>(width_) + static_cast<size_t>(wrap(x, width_));
  if (channels_ == 1) return Spectrum(value(i));
  return {value(3 * i), value(3 * i + 1), value(3 * i + 2)};
}

Spectrum BitmapTexture::eval(const SurfacePoint& point) const {
  const Vec2 uv = settings_.to_uv(point.uv);
  const float x = uv.x * static_cast<float>(width_), y = uv.y * static_cast<float>(height_);
  if (!(std::abs(x) < kFar && std::abs(y) < kFar)) return mean_;
  if (settings_.filter == BitmapFilter::kNearest)
    return pixel(static_cast<int>(std::floor(x)), static_cast<int>(std::floor(y)));
  const float left = std::floor(x - 0.5f), top = std::floor(y - 0.5f);
  const float wx = x - 0.5f - left, wy = y - 0.5f - top;
  const int i = static_cast<int>(left), j = static_cast<int>(top);
  return lerp(lerp(pixel(i, j), pixel(i + 1, j), wx), lerp(pixel(i, j + 1), pixel(i + 1, j + 1), wx), wy);
}

float BitmapTexture::scalar_pixel(int x, int y) const {
  const Spectrum v = pixel(x, y);
  return channels_ == 1 ? v[0] : v.luminance();
}

Vec2 BitmapTexture::gradient(const SurfacePoint& point) const {
  const Vec2 uv = settings_.to_uv(point.uv);
  const auto width = static_cast<float>(width_), height = static_cast<float>(height_);
  const float x = uv.x * width - 0.5f, y = uv.y * height - 0.5f;
  if (settings_.filter == BitmapFilter::kNearest || !(std::abs(x) < kFar && std::abs(y) < kFar)) return {0, 0};
  const float left = std::floor(x), top = std::floor(y);
  const int i = static_cast<int>(left), j = static_cast<int>(top);
  const float f00 = scalar_pixel(i, j), f10 = scalar_pixel(i + 1, j);
  const float f01 = scalar_pixel(i, j + 1), f11 = scalar_pixel(i + 1, j + 1);
  return settings_.to_uv.pull_back(
      {width * std::lerp(f10 - f00, f11 - f01, y - top), height * std::lerp(f01 - f00, f11 - f10, x - left)});
}

float BitmapTexture::eval_scalar(const SurfacePoint& point) const {
  const Spectrum v = eval(point);
  return channels_ == 1 ? v[0] : v.luminance();
}

}  // namespace turbid
