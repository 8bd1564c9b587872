#pragma once
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/vector.h"

namespace turbid {

/// What a file says about its picture, by name ("scene", "command", "seed" ...).
using Metadata = std::map<std::string, std::string>;

/// A picture in memory: named channels of floats, each row by row from the top. Colour channels (R, G, B, Y) are linear
/// and carry the unit of the picture, radiance for a render. Layers have dotted names as in OpenEXR: "m2.X".
class Image {
 public:
  Image() = default;
  /// All zero. Names must be distinct.
  Image(int width, int height, std::vector<std::string> channel_names);

  int width() const { return width_; }
  int height() const { return height_; }
  size_t pixel_count() const { return static_cast<size_t>(width_) * static_cast<size_t>(height_); }

  const std::vector<std::string>& channel_names() const { return names_; }
  size_t channel_count() const { return names_.size(); }
  bool has(std::string_view name) const;
  /// True when there is a channel of each of these names.
  bool has_all(std::initializer_list<std::string_view> names) const;
  /// The pixels of a channel; std::out_of_range when there is none of that name.
  std::span<float> channel(std::string_view name);
  std::span<const float> channel(std::string_view name) const;
  std::span<float> channel(size_t index) { return channels_[index]; }
  std::span<const float> channel(size_t index) const { return channels_[index]; }

  /// Where the first pixel stands in the whole picture, of which this may be a part: a crop.
  Vec2i offset{0, 0};
  /// Size of the whole picture; 0: this image is the whole.
  Vec2i full_size{0, 0};
  Metadata metadata;

 private:
  int width_ = 0, height_ = 0;
  std::vector<std::string> names_;
  std::vector<std::vector<float>> channels_;
};

/// The colour of an image as three channels: R, G, B, or a single Y (or any single channel) three times; layers are not
/// looked at. Throws FileError in the name of `path` when there is no colour.
std::vector<std::span<const float>> color_channels(const Image& image, const std::string& path);

}  // namespace turbid
