#include "image/jpeg_tables.h"

#include <algorithm>
#include <cstdint>

namespace turbid {
namespace {

// Markers of ITU-T T.81, table B.1; each follows a byte 0xff.
constexpr uint8_t kHuffmanTables = 0xc4, kFirstRestart = 0xd0, kImageEnd = 0xd9, kTemporary = 0x01;
constexpr size_t kCountsPerTable = 16;
constexpr size_t kMostCodes = 256;

uint8_t byte_at(std::string_view bytes, size_t i) { return static_cast<uint8_t>(bytes[i]); }

/// A DHT segment without marker and length: tables of a class byte, 16 counts, and as many values as these say.
bool tables_are_sound(std::string_view segment) {
  for (size_t at = 0; at + 1 + kCountsPerTable <= segment.size();) {
    size_t codes = 0;
    for (size_t i = 0; i < kCountsPerTable; ++i) codes += byte_at(segment, at + 1 + i);
    if (codes > kMostCodes) return false;
    at += 1 + kCountsPerTable + codes;
  }
  return true;
}

}  // namespace

bool has_sound_huffman_tables(std::string_view bytes) {
  if (!bytes.starts_with("\xff\xd8")) return true;
  // From marker to marker; what lies between segments (entropy-coded data, padding) is searched for the next one.
  for (size_t at = 2; at + 4 <= bytes.size();) {
    const uint8_t marker = byte_at(bytes, at + 1);
    if (byte_at(bytes, at) != 0xff || marker == 0 || marker == 0xff || marker == kTemporary ||
        (marker >= kFirstRestart && marker <= kImageEnd)) {
      ++at;
      continue;
    }
    const size_t length = byte_at(bytes, at + 2) * size_t{256} + byte_at(bytes, at + 3);
    // The last table may reach beyond the segment's length: all that follows is looked at.
    if (marker == kHuffmanTables && length > 2) {
      const std::string_view rest = bytes.substr(at + 4);
      if (!tables_are_sound(rest.substr(0, std::max<size_t>(length - 2, 1 + kCountsPerTable)))) return false;
    }
    at += 2 + std::max<size_t>(length, 2);
  }
  return true;
}

}  // namespace turbid
