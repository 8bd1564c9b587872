#pragma once
#include <bit>
#include <cstdint>
#include <cstring>
#include <span>

#include "core/rng.h"

namespace turbid {

/// A 64-bit hash of bytes, to notice damage and differences; not against malice. `start` chains pieces.
inline uint64_t hash_bytes(std::span<const char> bytes, uint64_t start = 0) {
  uint64_t h = mix_bits(start ^ (bytes.size() + 0x9e3779b97f4a7c15ull));
  size_t i = 0;
  for (; i + 8 <= bytes.size(); i += 8) {
    uint64_t word;
    std::memcpy(&word, bytes.data() + i, 8);
    h = (std::rotl(h, 23) ^ word) * 0x9e3779b97f4a7c15ull;
  }
  for (; i < bytes.size(); ++i) h = (std::rotl(h, 23) ^ static_cast<unsigned char>(bytes[i])) * 0x9e3779b97f4a7c15ull;
  return mix_bits(h);
}

}  // namespace turbid
