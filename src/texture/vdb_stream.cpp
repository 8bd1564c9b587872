#include "texture/vdb_stream.h"

#include <Imath/half.h>
#include <blosc.h>
#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <bit>
#include <optional>

namespace turbid {
namespace {

/// What stands in for the values of inactive voxels, as the byte in front of a node's values says. "Other" values
/// follow that byte, the choice after them is a mask.
enum NodeContent : uint8_t {
  kBackground = 0,
  kMinusBackground = 1,
  kOneOther = 2,
  kMinusBackgroundOrBackground = 3,
  kOneOtherOrBackground = 4,
  kTwoOthers = 5,
  kAllValues = 6,  ///< nothing is left out
};

std::vector<float> read_numbers(ByteReader& file, int count) {
  std::vector<float> numbers(static_cast<size_t>(count));
  for (float& v : numbers) v = file.read<float>();
  return numbers;
}

void inflate_into(ByteReader& file, std::span<const char> packed, std::span<char> out) {
  auto size = static_cast<uLongf>(out.size());
  const int status = uncompress(reinterpret_cast<Bytef*>(out.data()), &size,
                                reinterpret_cast<const Bytef*>(packed.data()), static_cast<uLong>(packed.size()));
  if (status != Z_OK || size != out.size()) file.fail("damaged: zip data cannot be unpacked");
}

void unblosc_into(ByteReader& file, std::span<const char> packed, std::span<char> out) {
  size_t size = 0;
  const bool valid = blosc_cbuffer_validate(packed.data(), packed.size(), &size) == 0 && size == out.size();
  const int got = valid ? blosc_decompress_ctx(packed.data(), out.data(), out.size(), 1) : -1;
  if (got < 0 || static_cast<size_t>(got) != out.size()) file.fail("damaged: blosc data cannot be unpacked");
}

/// `size` bytes, packed or not.
std::vector<char> read_packed(ByteReader& file, const VdbEncoding& encoding, size_t size) {
  std::vector<char> bytes(size);
  std::span<const char> plain;
  if (encoding.zip || encoding.blosc) {
    const auto stored = file.read<int64_t>();  // negative: as many bytes, not packed
    if (stored > 0) {
      const std::span<const char> packed = file.take(static_cast<size_t>(stored));
      (encoding.blosc ? unblosc_into : inflate_into)(file, packed, bytes);
      return bytes;
    }
    if (static_cast<uint64_t>(-stored) != size) file.fail("damaged: a node has the wrong size");
  }
  plain = file.take(size);
  std::copy(plain.begin(), plain.end(), bytes.begin());
  return bytes;
}

std::vector<float> read_floats(ByteReader& file, const VdbEncoding& encoding, size_t count) {
  std::vector<float> values(count);
  if (!encoding.half) {
    const std::vector<char> bytes = read_packed(file, encoding, count * sizeof(float));
    if (count > 0) std::memcpy(values.data(), bytes.data(), bytes.size());
  } else if (count > 0) {  // of no halves there is no trace
    const std::vector<char> bytes = read_packed(file, encoding, count * sizeof(uint16_t));
    for (size_t i = 0; i < count; ++i) {
      uint16_t bits;
      std::memcpy(&bits, bytes.data() + i * sizeof(bits), sizeof(bits));
      Imath::half h;
      h.setBits(bits);
      values[i] = static_cast<float>(h);
    }
  }
  return values;
}

}  // namespace

size_t VdbMask::count() const {
  size_t sum = 0;
  for (const char byte : bytes_) sum += static_cast<size_t>(std::popcount(static_cast<unsigned char>(byte)));
  return sum;
}

std::string read_vdb_string(ByteReader& file) {
  const std::span<const char> text = file.take(file.read<uint32_t>());
  return {text.begin(), text.end()};
}

std::vector<float> read_vdb_values(ByteReader& file, const VdbEncoding& encoding, const VdbMask& active) {
  const auto content = file.read<uint8_t>();
  if (content > kAllValues) file.fail(fmt::format("damaged: unknown content {} of a node", content));
  std::vector<float> off = encoding.background, on = encoding.background;  // by the mask, where there is one
  if (content != kBackground)
    for (float& v : off) v = -v;
  if (content == kOneOther || content == kOneOtherOrBackground || content == kTwoOthers)
    off = read_numbers(file, encoding.channels);
  if (content == kTwoOthers) on = read_numbers(file, encoding.channels);
  std::optional<VdbMask> choice;
  if (content == kMinusBackgroundOrBackground || content == kOneOtherOrBackground || content == kTwoOthers)
    choice.emplace(file, active.size());

  const auto width = static_cast<size_t>(encoding.channels);
  const size_t total = active.size();
  const size_t present = encoding.active_mask && content != kAllValues ? active.count() : total;
  std::vector<float> values = read_floats(file, encoding, present * width);
  if (present == total) return values;
  std::vector<float> expanded(total * width);
  size_t from = 0;
  for (size_t i = 0; i < total; ++i) {
    const float* source = choice && choice->on(i) ? on.data() : off.data();
    if (active.on(i)) source = &values[width * from++];
    std::copy_n(source, width, &expanded[i * width]);
  }
  return expanded;
}

}  // namespace turbid
