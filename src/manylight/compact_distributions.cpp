#include "manylight/compact_distributions.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "manylight/lanes.h"

namespace turbid {
namespace {

constexpr int kLargestCode = 255;
constexpr float kStepsPerOctave = 12;

std::array<uint64_t, 256> make_values() {
  std::array<uint64_t, 256> values{};
  for (int code = 1; code <= kLargestCode; ++code)
    values[static_cast<size_t>(code)] =
        static_cast<uint64_t>(std::llround(0x1p32 * std::exp2((code - kLargestCode) / double{kStepsPerOctave})));
  return values;
}

/// Codes of ratios to the largest weight, those of a vector at once.
IntLanes encode(const Lanes& ratios) {
  constexpr float kPerNeper = kStepsPerOctave * std::numbers::log2e_v<float>;
  const Lanes steps = kLargestCode + kPerNeper * log_lanes(max(ratios, Lanes(1e-30f)));
  return std::experimental::static_simd_cast<IntLanes>(max(min(floor(steps + 0.5f), Lanes(kLargestCode)), Lanes(0.0f)));
}

}  // namespace

const std::array<uint64_t, 256> CompactDistributions::kValues = make_values();

namespace {
/// The same in single precision.
const std::array<float, 256> kRoundedValues = [] {
  std::array<float, 256> values{};
  const std::array<uint64_t, 256> exact = make_values();
  for (size_t code = 0; code < exact.size(); ++code) values[code] = static_cast<float>(exact[code]);
  return values;
}();
}  // namespace

CompactDistributions::CompactDistributions(size_t rows, size_t lights)
    : lights_(lights),
      blocks_(blocks_of(lights)),
      codes_(rows * lights),
      sums_(rows * blocks_),
      totals_(rows),
      inverse_totals_(rows) {}

size_t CompactDistributions::bytes_for(size_t rows, size_t lights) {
  return rows * (lights + blocks_of(lights) * sizeof(uint64_t) + sizeof(uint64_t) + sizeof(double));
}

void CompactDistributions::set(size_t row, std::span<const float> weights) {
  float largest = 0;
  for (const float weight : weights)
    if (std::isfinite(weight)) largest = std::max(largest, weight);
  if (!(largest > 0)) return clear(row);
  uint8_t* const codes = codes_.data() + row * lights_;
  for (size_t light = 0; light < lights_; light += kLanes) {
    const size_t count = std::min(kLanes, lights_ - light);
    const Lanes ratios([&](auto i) {
      return i < count && weights[light + i] > 0 ? std::min(weights[light + i], largest) / largest : 0.0f;
    });
    const IntLanes found = encode(ratios);
    for (size_t i = 0; i < count; ++i) codes[light + i] = static_cast<uint8_t>(found[i]);
  }
  uint64_t total = 0;
  for (size_t light = 0; light < lights_; ++light) {
    total += kValues[codes[light]];
    if (light % kBlock == kBlock - 1 || light + 1 == lights_) sums_[row * blocks_ + light / kBlock] = total;
  }
  totals_[row] = total;
  inverse_totals_[row] = 1 / static_cast<double>(total);
}

void CompactDistributions::clear(size_t row) {
  std::fill_n(codes_.begin() + static_cast<std::ptrdiff_t>(row * lights_), lights_, uint8_t{0});
  totals_[row] = 0;
  inverse_totals_[row] = 0;
}

void CompactDistributions::add_probs(size_t row, double factor, size_t first, std::span<float> sums) const {
  const auto scale = static_cast<float>(factor * inverse_totals_[row]);
  const uint8_t* const codes = codes_.data() + row * lights_ + first;
  for (size_t i = 0; i < sums.size(); ++i) sums[i] += scale * kRoundedValues[codes[i]];
}

LightChoice CompactDistributions::sample(size_t row, double u) const {
  // u has 53 bits, totals have less than 2^(32 + log2(lights)): rounding moves no probability that could be seen.
  const uint64_t at = std::min(static_cast<uint64_t>(u * static_cast<double>(totals_[row])), totals_[row] - 1);
  const uint64_t* const sums = sums_.data() + row * blocks_;
  // std::upper_bound without branches, which would be guessed wrong half of the time.
  size_t block = 0;
  for (size_t left = blocks_; left > 1;) {
    const size_t half = left / 2;
    block += sums[block + half - 1] <= at ? half : 0;
    left -= half;
  }
  uint64_t sum = block > 0 ? sums[block - 1] : 0;
  size_t light = block * kBlock;
  // Four at a time while none of them is it.
  for (const size_t end = std::min(light + kBlock, lights_); light + 4 <= end; light += 4) {
    const uint8_t* const codes = codes_.data() + row * lights_ + light;
    const uint64_t four = (kValues[codes[0]] + kValues[codes[1]]) + (kValues[codes[2]] + kValues[codes[3]]);
    if (sum + four > at) break;
    sum += four;
  }
  while ((sum += kValues[code(row, light)]) <= at) ++light;
  return {light, prob(row, light)};
}

}  // namespace turbid
