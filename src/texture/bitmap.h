#pragma once
#include <array>
#include <string>
#include <vector>

#include "image/image_file.h"
#include "texture/texture.h"
#include "texture/uv_transform.h"

namespace turbid {

/// How a picture is read between and beyond its pixels.
enum class BitmapFilter { kBilinear, kNearest };
enum class BitmapWrap { kRepeat, kMirror, kClamp };

struct BitmapSettings {
  BitmapFilter filter = BitmapFilter::kBilinear;
  BitmapWrap wrap = BitmapWrap::kRepeat;
  bool raw = false;  ///< 8- and 16-bit files hold plain numbers: no sRGB decoding
  UvTransform to_uv;
};

/// A picture spread over the uv square: u runs along its rows from the left, v down its columns from the **first (top)
/// row**, as in Mitsuba 3 (whose OBJ reader flips v). Pixel (i, j) of a w x h picture has its centre at
/// ((i + 1/2)/w, (j + 1/2)/h). Colours are made linear before they are interpolated. Alpha is not used.
///
/// 8-bit files stay 8-bit in memory, decoded through a table of 256 floats; others are kept as floats.
class BitmapTexture final : public Texture {
 public:
  /// Reads a file; throws FileError.
  explicit BitmapTexture(const std::string& path, const BitmapSettings& settings = {});
  /// Takes the channels of an image as they are: R, G, B, or else a single channel as grey.
  BitmapTexture(const Image& image, const BitmapSettings& settings, const std::string& name = "image");

  Spectrum eval(const SurfacePoint& point) const override;
  float eval_scalar(const SurfacePoint& point) const override;
  /// Exact for bilinear interpolation, 0 for nearest pixels.
  Vec2 gradient(const SurfacePoint& point) const override;
  Spectrum mean() const override { return mean_; }
  float max() const override { return max_; }

  int width() const { return width_; }
  int height() const { return height_; }
  bool is_grey() const { return channels_ == 1; }
  /// Bytes that the pixels take.
  size_t memory() const;

 private:
  /// encoded: values are those of the file, in [0, 1], sRGB unless raw.
  void store(const Image& image, const std::string& name, bool encoded);
  void summarise();
  int wrap(int i, int n) const;
  float value(size_t index) const { return bytes_.empty() ? floats_[index] : decode_[bytes_[index]]; }
  Spectrum pixel(int x, int y) const;
  float scalar_pixel(int x, int y) const;

  BitmapSettings settings_;
  int width_ = 0, height_ = 0;
  size_t channels_ = 0;  ///< 1 or 3, interleaved
  std::vector<uint8_t> bytes_;
  std::array<float, 256> decode_{};  ///< linear value of each byte
  std::vector<float> floats_;        ///< instead of bytes_
  Spectrum mean_;
  float max_ = 0;
};

}  // namespace turbid
