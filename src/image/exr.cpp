#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFloatAttribute.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStringAttribute.h>

#include <algorithm>
#include <cstring>
#include <optional>

#include "core/error.h"
#include "image/atomic_file.h"
#include "image/image_file.h"

namespace turbid {
namespace {

/// A file in memory, as OpenEXR reads it. Reading past the end throws, which is how truncated files are noticed.
class MemoryInput : public Imf::IStream {
 public:
  explicit MemoryInput(std::span<const char> bytes) : Imf::IStream("memory"), bytes_(bytes) {}

  bool read(char target[], int n) override {
    const auto count = static_cast<size_t>(n);
    if (n < 0 || position_ > bytes_.size() || bytes_.size() - position_ < count)
      throw std::runtime_error("file ends early");
    std::memcpy(target, bytes_.data() + position_, count);
    position_ += count;
    return position_ < bytes_.size();
  }
  uint64_t tellg() override { return position_; }
  void seekg(uint64_t position) override { position_ = position; }

 private:
  std::span<const char> bytes_;
  size_t position_ = 0;
};

/// A file that grows in memory while OpenEXR writes it.
class MemoryOutput : public Imf::OStream {
 public:
  MemoryOutput() : Imf::OStream("memory") {}

  void write(const char source[], int n) override {
    const auto count = static_cast<size_t>(n);
    if (bytes_.size() < position_ + count) bytes_.resize(position_ + count);
    std::memcpy(bytes_.data() + position_, source, count);
    position_ += count;
  }
  uint64_t tellp() override { return position_; }
  void seekp(uint64_t position) override { position_ = position; }
  const std::vector<char>& bytes() const { return bytes_; }

 private:
  std::vector<char> bytes_;
  size_t position_ = 0;
};

/// The header of a damaged file may claim any size. Compression shrinks no picture by more than this, so a claim beyond
/// it is refused before memory is asked for.
constexpr uint64_t kLargestExpansion = 4096;
constexpr uint64_t kAlwaysAllowedBytes = uint64_t{256} << 20;

std::string layer_of(const std::string& name) {
  const size_t dot = name.rfind('.');
  return dot == std::string::npos ? std::string() : name.substr(0, dot);
}

/// Layers by name, the unnamed first; inside each the order that people expect, R G B A, others by name.
bool comes_before(const std::string& a, const std::string& b) {
  const std::string layer_a = layer_of(a), layer_b = layer_of(b);
  if (layer_a != layer_b) return layer_a < layer_b;
  const auto rank = [](const std::string& name) {
    const std::string last = name.substr(name.rfind('.') + 1);
    const size_t place = last.size() == 1 ? std::string("RGBA").find(last) : std::string::npos;
    return std::min<size_t>(place, 4);
  };
  return std::pair(rank(a), a) < std::pair(rank(b), b);
}

Metadata read_metadata(const Imf::Header& header) {
  Metadata metadata;
  for (auto i = header.begin(); i != header.end(); ++i) {
    if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&i.attribute()))
      metadata[i.name()] = text->value();
    else if (const auto* integer = dynamic_cast<const Imf::IntAttribute*>(&i.attribute()))
      metadata[i.name()] = std::to_string(integer->value());
    else if (const auto* number = dynamic_cast<const Imf::FloatAttribute*>(&i.attribute());
             number && !std::strchr("ps", i.name()[0]))  // not the standard pixelAspectRatio, screenWindowWidth
      metadata[i.name()] = std::to_string(number->value());
  }
  return metadata;
}

/// Repeats a channel that the file stores at every xs-th column and ys-th row only.
void expand(std::vector<float>& coarse, int columns, int xs, int ys, std::span<float> target, int width) {
  for (size_t i = 0; i < target.size(); ++i) {
    const auto x = static_cast<int>(i % static_cast<size_t>(width)),
               y = static_cast<int>(i / static_cast<size_t>(width));
    target[i] = coarse[static_cast<size_t>(y / ys) * static_cast<size_t>(columns) + static_cast<size_t>(x / xs)];
  }
}

Image read_from(const std::string& path, std::span<const char> bytes, const std::vector<std::string>& wanted) {
  MemoryInput stream(bytes);
  Imf::InputFile file(stream, 0);
  const Imf::Header& header = file.header();
  const Imath::Box2i window = header.dataWindow();
  const auto width = static_cast<int64_t>(window.max.x) - window.min.x + 1;
  const auto height = static_cast<int64_t>(window.max.y) - window.min.y + 1;

  std::vector<std::string> names;
  for (auto i = header.channels().begin(); i != header.channels().end(); ++i) names.emplace_back(i.name());
  std::sort(names.begin(), names.end(), comes_before);
  if (!wanted.empty()) {
    for (const std::string& name : wanted)
      if (std::find(names.begin(), names.end(), name) == names.end())
        throw FileError(path, "has no channel '" + name + "'");
    names = wanted;
  }
  const uint64_t claimed = static_cast<uint64_t>(width) * static_cast<uint64_t>(height) * 4 * names.size();
  if (width <= 0 || height <= 0 || width > (1 << 24) || height > (1 << 24) ||
      claimed > std::max(kAlwaysAllowedBytes, kLargestExpansion * bytes.size()))
    throw FileError(path,
                    "damaged: its header claims " + std::to_string(width) + " x " + std::to_string(height) + " pixels");

  Image image(static_cast<int>(width), static_cast<int>(height), names);
  image.offset = window.min - header.displayWindow().min;
  image.full_size = header.displayWindow().max - header.displayWindow().min + Vec2i(1, 1);
  image.metadata = read_metadata(header);

  // Channels at full resolution are read in place; coarser ones into buffers of their own and then repeated.
  Imf::FrameBuffer frame;
  struct Coarse {
    size_t channel;
    int xs, ys, columns;
    std::vector<float> pixels;
  };
  std::vector<Coarse> coarse;
  coarse.reserve(names.size());
  for (size_t c = 0; c < names.size(); ++c) {
    const Imf::Channel& channel = header.channels()[names[c].c_str()];
    const int xs = channel.xSampling, ys = channel.ySampling;
    auto columns = static_cast<int>(width);
    float* first = image.channel(c).data();
    if (xs != 1 || ys != 1) {
      columns = (static_cast<int>(width) + xs - 1) / xs;
      const int rows = (static_cast<int>(height) + ys - 1) / ys;
      coarse.push_back(
          {c, xs, ys, columns, std::vector<float>(static_cast<size_t>(columns) * static_cast<size_t>(rows))});
      first = coarse.back().pixels.data();
    }
    frame.insert(names[c], Imf::Slice::Make(Imf::FLOAT, first, window, sizeof(float),
                                            sizeof(float) * static_cast<size_t>(columns), xs, ys));
  }
  file.setFrameBuffer(frame);
  file.readPixels(window.min.y, window.max.y);
  for (Coarse& c : coarse) expand(c.pixels, c.columns, c.xs, c.ys, image.channel(c.channel), image.width());
  return image;
}

}  // namespace

Image read_exr(const std::string& path, const std::vector<std::string>& channels) {
  const std::string bytes = read_file(path);
  try {
    return read_from(path, bytes, channels);
  } catch (const FileError&) {
    throw;
  } catch (const std::exception& error) {
    throw FileError(path, std::string("not a readable OpenEXR file: ") + error.what());
  }
}

void write_exr(const std::string& path, const Image& image) {
  MemoryOutput stream;
  try {
    const Vec2i size(image.width(), image.height());
    const Imath::Box2i window(image.offset, image.offset + size - Vec2i(1, 1));
    const Vec2i full = image.full_size == Vec2i(0, 0) ? size : image.full_size;
    Imf::Header header(Imath::Box2i(Vec2i(0, 0), full - Vec2i(1, 1)), window);
    header.compression() = Imf::ZIP_COMPRESSION;
    for (const auto& [name, value] : image.metadata) header.insert(name, Imf::StringAttribute(value));
    Imf::FrameBuffer frame;
    for (size_t c = 0; c < image.channel_count(); ++c) {
      const std::string& name = image.channel_names()[c];
      header.channels().insert(name, Imf::Channel(Imf::FLOAT));
      frame.insert(name, Imf::Slice::Make(Imf::FLOAT, image.channel(c).data(), window));
    }
    Imf::OutputFile file(stream, header, 0);
    file.setFrameBuffer(frame);
    file.writePixels(image.height());
  } catch (const std::exception& error) {
    throw FileError(path, std::string("cannot be encoded as OpenEXR: ") + error.what());
  }
  write_file_atomically(path, stream.bytes());
}

}  // namespace turbid
