#define STBI_NO_STDIO
#include <stb/stb_image.h>

#include <array>
#include <climits>
#include <memory>

#include "core/error.h"
#include "image/atomic_file.h"
#include "image/color.h"
#include "image/image_file.h"
#include "image/jpeg_tables.h"

namespace turbid {
namespace {

struct StbFree {
  void operator()(void* pixels) const { stbi_image_free(pixels); }
};

std::vector<std::string> channel_names(int count) {
  switch (count) {
    case 1:
      return {"Y"};
    case 2:
      return {"Y", "A"};
    case 3:
      return {"R", "G", "B"};
    default:
      return {"R", "G", "B", "A"};
  }
}

/// Spreads interleaved pixels over channels: value(v, is_alpha) makes the float.
template <class T, class Value>
Image make_image(const T* pixels, int width, int height, int count, const Value& value) {
  Image image(width, height, channel_names(count));
  for (size_t c = 0; c < image.channel_count(); ++c) {
    const std::span<float> target = image.channel(c);
    const bool is_alpha = image.channel_names()[c] == "A";
    for (size_t i = 0; i < target.size(); ++i) target[i] = value(pixels[i * image.channel_count() + c], is_alpha);
  }
  return image;
}

Image read_ldr(const std::string& path, const std::string& bytes, PixelEncoding encoding) {
  if (bytes.size() > INT_MAX) throw FileError(path, "is too large for a picture of its kind");
  if (!has_sound_huffman_tables(bytes)) throw FileError(path, "is a damaged JPEG file: impossible Huffman table");
  const auto* data = reinterpret_cast<const stbi_uc*>(bytes.data());
  const auto size = static_cast<int>(bytes.size());
  int width = 0, height = 0, count = 0;
  const auto check = [&](const void* pixels) {
    if (!pixels)
      throw FileError(
          path, std::string("not a readable picture (EXR, PNG, JPEG, BMP, TGA or HDR): ") + stbi_failure_reason());
  };
  const bool decode = encoding == PixelEncoding::kColor;
  if (stbi_is_hdr_from_memory(data, size)) {
    const std::unique_ptr<float, StbFree> pixels(stbi_loadf_from_memory(data, size, &width, &height, &count, 0));
    check(pixels.get());
    return make_image(pixels.get(), width, height, count, [](float v, bool) { return v; });
  }
  if (stbi_is_16_bit_from_memory(data, size)) {
    const std::unique_ptr<stbi_us, StbFree> pixels(stbi_load_16_from_memory(data, size, &width, &height, &count, 0));
    check(pixels.get());
    return make_image(pixels.get(), width, height, count, [decode](stbi_us v, bool is_alpha) {
      const float linear = static_cast<float>(v) / 65535.0f;
      return decode && !is_alpha ? srgb_to_linear(linear) : linear;
    });
  }
  const std::unique_ptr<stbi_uc, StbFree> pixels(stbi_load_from_memory(data, size, &width, &height, &count, 0));
  check(pixels.get());
  std::array<float, 256> decoded;
  for (size_t v = 0; v < decoded.size(); ++v) decoded[v] = srgb_to_linear(static_cast<float>(v) / 255.0f);
  return make_image(pixels.get(), width, height, count, [&](stbi_uc v, bool is_alpha) {
    return decode && !is_alpha ? decoded[v] : static_cast<float>(v) / 255.0f;
  });
}

}  // namespace

Image read_image(const std::string& path, PixelEncoding encoding) {
  constexpr std::string_view kExrMagic = "\x76\x2f\x31\x01";
  const std::string bytes = read_file(path);
  if (bytes.empty()) throw FileError(path, "is empty");
  return bytes.starts_with(kExrMagic) ? read_exr(path) : read_ldr(path, bytes, encoding);
}

}  // namespace turbid
