#define STBI_WRITE_NO_STDIO
#include <stb/stb_image_write.h>

#include <cmath>

#include "image/atomic_file.h"
#include "image/color.h"
#include "image/image_file.h"
#include "image/tone_map.h"

namespace turbid {
namespace {

unsigned char to_byte(float v) { return static_cast<unsigned char>(std::lround(255 * std::clamp(v, 0.0f, 1.0f))); }

void append(void* context, void* data, int size) {
  static_cast<std::string*>(context)->append(static_cast<const char*>(data), static_cast<size_t>(size));
}

}  // namespace

void write_png(const std::string& path, const Image& image, float exposure) {
  const auto color = color_channels(image, path);
  const bool has_alpha = image.has("A");
  const float scale = std::exp2(exposure);
  const size_t stride = has_alpha ? 4 : 3;
  std::vector<unsigned char> pixels(image.pixel_count() * stride);
  for (size_t i = 0; i < image.pixel_count(); ++i) {
    // EXR colour is multiplied by alpha, PNG colour is not.
    const float alpha = has_alpha ? image.channel("A")[i] : 1;
    const float unmultiply = alpha > 0 ? 1 / alpha : 1;
    for (size_t c = 0; c < 3; ++c)
      pixels[i * stride + c] = to_byte(linear_to_srgb(tone_curve(color[c][i] * scale * unmultiply)));
    if (has_alpha) pixels[i * stride + 3] = to_byte(alpha);
  }
  std::string bytes;
  const int channels = static_cast<int>(stride);
  stbi_write_png_to_func(append, &bytes, image.width(), image.height(), channels, pixels.data(),
                         image.width() * channels);
  write_file_atomically(path, bytes);
}

}  // namespace turbid
