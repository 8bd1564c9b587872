#include "render/checkpoint.h"

#include <fmt/format.h>

#include <cstring>
#include <fstream>
#include <type_traits>

#include "core/error.h"
#include "image/atomic_file.h"
#include "render/hash.h"

namespace turbid {
namespace {

constexpr uint32_t kVersion = 1;
constexpr char kMagic[12] = {'t', 'u', 'r', 'b', 'i', 'd', ' ', 'c', 'k', 'p', 't', '\n'};

/// The file is this, then the pixels as they are in memory, then a hash of both. Little endian.
struct Header {
  char magic[12];
  uint32_t version;
  uint64_t fingerprint;
  double seconds;
  uint64_t samples;
  int32_t width, height;
};
static_assert(sizeof(Header) == 48 && std::is_trivially_copyable_v<Header>);
static_assert(sizeof(PixelSums) == (3 * kChannels + 1) * sizeof(double) && std::is_trivially_copyable_v<PixelSums>);

template <class T>
std::span<const char> bytes_of(std::span<T> values) {
  return {reinterpret_cast<const char*>(values.data()), values.size_bytes()};
}

template <class T>
std::span<const char> bytes_of(const T& value) {
  return bytes_of(std::span(&value, 1));
}

}  // namespace

void write_checkpoint(const std::string& path, uint64_t fingerprint, double seconds, const Film& film) {
  Header header{{}, kVersion, fingerprint, seconds, film.samples(), film.size().x, film.size().y};
  std::memcpy(header.magic, kMagic, sizeof kMagic);
  const auto pixels = bytes_of(film.pixels());
  const uint64_t checksum = hash_bytes(pixels, hash_bytes(bytes_of(header)));
  write_file_atomically(path, {bytes_of(header), pixels, bytes_of(checksum)});
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
  const size_t payload = bytes.size() - sizeof header - sizeof(uint64_t);
  uint64_t checksum;
  std::memcpy(&checksum, bytes.data() + sizeof header + payload, sizeof checksum);
  const std::span<const char> pixels(bytes.data() + sizeof header, payload);
  const bool size_fits =
      header.width > 0 && header.height > 0 &&
      payload / sizeof(PixelSums) / static_cast<size_t>(header.width) == static_cast<size_t>(header.height) &&
      payload == sizeof(PixelSums) * static_cast<size_t>(header.width) * static_cast<size_t>(header.height);
  if (!size_fits || checksum != hash_bytes(pixels, hash_bytes(bytes_of(header))))
    throw FileError(path, "is a damaged checkpoint (its checksum does not fit)");
  Checkpoint checkpoint{header.fingerprint, header.seconds, Film({header.width, header.height})};
  std::memcpy(checkpoint.film.pixels().data(), pixels.data(), pixels.size());
  checkpoint.film.add_samples(header.samples);
  return checkpoint;
}

bool looks_like_checkpoint(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  char magic[sizeof kMagic] = {};
  return file.read(magic, sizeof magic) && std::memcmp(magic, kMagic, sizeof magic) == 0;
}

}  // namespace turbid
