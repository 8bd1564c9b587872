#pragma once
#include <bit>
#include <cstdint>

namespace turbid {

/// Scrambles 64 bits so that every input bit reaches every output bit (the finaliser of SplitMix64, Steele et al.
/// 2014).
constexpr uint64_t mix_bits(uint64_t v) {
  v ^= v >> 30;
  v *= 0xbf58476d1ce4e5b9ull;
  v ^= v >> 27;
  v *= 0x94d049bb133111ebull;
  return v ^ (v >> 31);
}

/// A hash of several integers: the counters (seed, pass, pixel, sample ...) that name a random stream.
template <class... Rest>
constexpr uint64_t hash_counters(uint64_t first, Rest... rest) {
  uint64_t h = mix_bits(first + 0x9e3779b97f4a7c15ull);
  ((h = mix_bits(h ^ (static_cast<uint64_t>(rest) + 0x9e3779b97f4a7c15ull))), ...);
  return h;
}

/// The largest float below 1.
inline constexpr float kOneMinusEpsilon = 0x1.fffffep-1f;

/// PCG32 (O'Neill 2014): 64 bits of state, period 2^64, seeded from a counter so that any stream can be reproduced
/// alone.
class Rng {
 public:
  Rng() = default;
  explicit Rng(uint64_t counter) : state_(mix_bits(counter)), increment_((mix_bits(~counter) << 1) | 1) { next_u32(); }

  uint32_t next_u32() {
    const uint64_t old = state_;
    state_ = old * 6364136223846793005ull + increment_;
    const auto xorshifted = static_cast<uint32_t>(((old >> 18) ^ old) >> 27);
    return std::rotr(xorshifted, static_cast<int>(old >> 59));
  }

  /// Uniform in [0, 1), with 24 bits.
  float next_float() { return static_cast<float>(next_u32() >> 8) * 0x1p-24f; }
  /// Uniform in [0, 1), with 53 bits; takes two words of the stream.
  double next_double() {
    const uint64_t high = next_u32();
    return static_cast<double>(((high << 32) | next_u32()) >> 11) * 0x1p-53;
  }

 private:
  uint64_t state_ = 0x853c49e6748fea9bull;
  uint64_t increment_ = 0xda3e39cb94b95bdbull;
};

}  // namespace turbid
