#include "core/sampler.h"

namespace turbid {
namespace {

constexpr uint32_t reverse_bits(uint32_t v) {
  v = ((v >> 1) & 0x55555555u) | ((v & 0x55555555u) << 1);
  v = ((v >> 2) & 0x33333333u) | ((v & 0x33333333u) << 2);
  v = ((v >> 4) & 0x0f0f0f0fu) | ((v & 0x0f0f0f0fu) << 4);
  v = ((v >> 8) & 0x00ff00ffu) | ((v & 0x00ff00ffu) << 8);
  return (v >> 16) | (v << 16);
}

/// A hash in which bit i of the result depends on bits 0..i of the input only: applied to bit-reversed digits it is a
/// nested uniform (Owen) scramble (Laine & Karras 2011, constants of Vegdahl 2021 as given by Burley 2020).
constexpr uint32_t laine_karras(uint32_t v, uint32_t seed) {
  v ^= v * 0x3d20adeau;
  v += seed;
  v *= (seed >> 16) | 1;
  v ^= v * 0x05526c56u;
  v ^= v * 0x53a22864u;
  return v;
}

constexpr uint32_t owen_scramble(uint32_t v, uint32_t seed) {
  return reverse_bits(laine_karras(reverse_bits(v), seed));
}

/// Second dimension of Sobol's sequence: its generator matrix is Pascal's triangle modulo 2.
constexpr uint32_t sobol_second(uint32_t index) {
  uint32_t result = 0;
  for (uint32_t column = 0x80000000u; index; index >>= 1, column ^= column >> 1)
    if (index & 1) result ^= column;
  return result;
}

float to_unit(uint32_t v) { return static_cast<float>(v >> 8) * 0x1p-24f; }

}  // namespace

float Sampler::sobol_1d() {
  if (dimension_ >= kSobolDimensions) return rng_.next_float();
  const uint64_t seed = hash_counters(scramble_, dimension_++);
  // The shuffled index keeps every block of 2^k samples together, so each dimension stays a (0,1)-sequence of its own.
  const uint32_t shuffled = owen_scramble(index_, static_cast<uint32_t>(seed));
  return to_unit(owen_scramble(reverse_bits(shuffled), static_cast<uint32_t>(seed >> 32)));
}

Vec2 Sampler::sobol_2d() {
  if (dimension_ >= kSobolDimensions) {
    const float u = rng_.next_float();
    return {u, rng_.next_float()};
  }
  const uint64_t seed = hash_counters(scramble_, dimension_);
  dimension_ += 2;
  const uint32_t shuffled = owen_scramble(index_, static_cast<uint32_t>(seed));
  const uint64_t digits = mix_bits(seed + 1);
  return {to_unit(owen_scramble(reverse_bits(shuffled), static_cast<uint32_t>(digits))),
          to_unit(owen_scramble(sobol_second(shuffled), static_cast<uint32_t>(digits >> 32)))};
}

}  // namespace turbid
