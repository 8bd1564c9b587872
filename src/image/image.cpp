#include "image/image.h"

#include <algorithm>
#include <stdexcept>

#include "core/error.h"

namespace turbid {
namespace {

size_t index_of(const std::vector<std::string>& names, std::string_view name) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) throw std::out_of_range("no channel named '" + std::string(name) + "'");
  return static_cast<size_t>(found - names.begin());
}

}  // namespace

Image::Image(int width, int height, std::vector<std::string> channel_names)
    : width_(width), height_(height), names_(std::move(channel_names)) {
  channels_.assign(names_.size(), std::vector<float>(pixel_count()));
}

bool Image::has(std::string_view name) const { return std::find(names_.begin(), names_.end(), name) != names_.end(); }

bool Image::has_all(std::initializer_list<std::string_view> names) const {
  return std::all_of(names.begin(), names.end(), [this](std::string_view name) { return has(name); });
}

std::span<float> Image::channel(std::string_view name) { return channels_[index_of(names_, name)]; }
std::span<const float> Image::channel(std::string_view name) const { return channels_[index_of(names_, name)]; }

std::vector<std::span<const float>> color_channels(const Image& image, const std::string& path) {
  if (image.has_all({"R", "G", "B"})) return {image.channel("R"), image.channel("G"), image.channel("B")};
  const bool grey = image.has("Y") && !image.has("X");
  if (grey || image.channel_count() == 1) {
    const auto y = grey ? image.channel("Y") : image.channel(size_t{0});
    return {y, y, y};
  }
  std::string names;
  for (const std::string& name : image.channel_names()) names += (names.empty() ? "" : ", ") + name;
  throw FileError(path, "no colour: expected channels R, G, B or Y, found " + (names.empty() ? "none" : names));
}

}  // namespace turbid
