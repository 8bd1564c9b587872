#include "render/checkpoint.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <type_traits>

#include "core/error.h"
#include "core/hash.h"
#include "image/atomic_file.h"

namespace turbid {
namespace {

constexpr uint32_t kVersion = 2;
constexpr char kMagic[12] = {'t', 'u', 'r', 'b', 'i', 'd', ' ', 'c', 'k', 'p', 't', '\n'};

/// The file is this, then the names of the layers (each ends with a line feed), then pixels and layers as they are in
/// memory, then a hash of all that. Little endian.
struct Header {
  char magic[12];
  uint32_t version;
  uint64_t fingerprint;
  double seconds;
  uint64_t samples;
  int32_t width, height;
  uint64_t names_size;
};
static_assert(sizeof(Header) == 56 && std::is_trivially_copyable_v<Header>);
static_assert(sizeof(PixelSums) == (3 * kChannels + 1) * sizeof(double) && std::is_trivially_copyable_v<PixelSums>);

template <class T>
std::span<const char> bytes_of(std::span<T> values) {
  return {reinterpret_cast<const char*>(values.data()), values.size_bytes()};
}

template <class T>
std::span<const char> bytes_of(const T& value) {
  return bytes_of(std::span(&value, 1));
}

std::vector<std::string> lines_of(std::span<const char> text) {
  std::vector<std::string> lines;
  for (auto at = text.begin(); at != text.end();) {
    const auto end = std::find(at, text.end(), '\n');
    lines.emplace_back(at, end);
    at = end == text.end() ? end : end + 1;
  }
  return lines;
}

}  // namespace

void write_checkpoint(const std::string& path, uint64_t fingerprint, double seconds, const Film& film) {
  std::string names;
  for (const std::string& name : film.layer_names()) names += name + '\n';
  Header header{{}, kVersion, fingerprint, seconds, film.samples(), film.size().x, film.size().y, names.size()};
  std::memcpy(header.magic, kMagic, sizeof kMagic);
  uint64_t checksum = 0;
  for (const auto part :
       {bytes_of(header), std::span<const char>(names), bytes_of(film.pixels()), bytes_of(film.layers())})
    checksum = hash_bytes(part, checksum);
  write_file_atomically(
      path, {bytes_of(header), names, bytes_of(film.pixels()), bytes_of(film.layers()), bytes_of(checksum)});
}

Checkpoint read_checkpoint(const std::string& path) {
  const std::string bytes = read_file(path);
  Header header;
  if (bytes.size() < sizeof header + sizeof(uint64_t) || std::memcmp(bytes.data(), kMagic, sizeof kMagic) != 0)
    throw FileError(path, "is not a checkpoint of turbid");
  std::memcpy(&header, bytes.data(), sizeof header);
  if (header.version != kVersion)
    throw FileError(
        path, fmt::format("is a checkpoint of format {}, this program reads format {}", header.version, kVersion));
  const FileError damaged(path, "is a damaged checkpoint (its checksum does not fit)");
  std::span<const char> rest = std::span<const char>(bytes).subspan(sizeof header);
  uint64_t checksum;
  rest = rest.first(rest.size() - sizeof checksum);
  std::memcpy(&checksum, rest.data() + rest.size(), sizeof checksum);
  if (header.width <= 0 || header.height <= 0 || header.names_size > rest.size()) throw damaged;
  const std::span<const char> names = rest.first(header.names_size);
  rest = rest.subspan(names.size());
  const auto layers = static_cast<size_t>(std::ranges::count(names, '\n'));
  const size_t per_pixel = sizeof(PixelSums) + layers * sizeof(double);
  const auto width = static_cast<size_t>(header.width), height = static_cast<size_t>(header.height);
  if (rest.size() / per_pixel / width != height || rest.size() != per_pixel * width * height) throw damaged;
  const auto pixels = rest.first(sizeof(PixelSums) * width * height), sums = rest.subspan(pixels.size());
  uint64_t expected = 0;
  for (const auto part : {bytes_of(header), names, pixels, sums}) expected = hash_bytes(part, expected);
  if (checksum != expected) throw damaged;

  Checkpoint checkpoint{header.fingerprint, header.seconds, Film({header.width, header.height}, lines_of(names))};
  std::memcpy(checkpoint.film.pixels().data(), pixels.data(), pixels.size());
  std::memcpy(checkpoint.film.layers().data(), sums.data(), sums.size());
  checkpoint.film.add_samples(header.samples);
  return checkpoint;
}

bool looks_like_checkpoint(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  char magic[sizeof kMagic] = {};
  return file.read(magic, sizeof magic) && std::memcmp(magic, kMagic, sizeof magic) == 0;
}

}  // namespace turbid
