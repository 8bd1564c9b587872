#include "manylight/compact_distributions.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace turbid {
namespace {

constexpr int kLargestCode = 255;
constexpr double kStepsPerOctave = 12, kLargestValue = 0x1p32;

std::array<uint64_t, kLargestCode + 1> make_values() {
  std::array<uint64_t, kLargestCode + 1> values{};
  for (int code = 1; code <= kLargestCode; ++code)
    values[static_cast<size_t>(code)] =
        static_cast<uint64_t>(std::llround(kLargestValue * std::exp2((code - kLargestCode) / kStepsPerOctave)));
  return values;
}
const std::array<uint64_t, kLargestCode + 1> kValues = make_values();

}  // namespace

uint64_t CompactDistributions::value(uint8_t code) { return kValues[code]; }

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
  uint8_t* const codes = codes_.data() + row * lights_;
  uint64_t total = 0;
  for (size_t light = 0; light < lights_; ++light) {
    const float weight = std::min(weights[light], largest);
    const double steps =
        weight > 0 ? kLargestCode + kStepsPerOctave * std::log2(static_cast<double>(weight / largest)) : 0;
    codes[light] = static_cast<uint8_t>(std::max(0L, std::lround(steps)));
    total += value(codes[light]);
    if (light % kBlock == kBlock - 1 || light + 1 == lights_) sums_[row * blocks_ + light / kBlock] = total;
  }
  totals_[row] = total;
  inverse_totals_[row] = total > 0 ? 1 / static_cast<double>(total) : 0;
}

LightChoice CompactDistributions::sample(size_t row, double u) const {
  // u has 53 bits, totals have less than 2^(32 + log2(lights)): rounding moves no probability that could be seen.
  const uint64_t at = std::min(static_cast<uint64_t>(u * static_cast<double>(totals_[row])), totals_[row] - 1);
  const uint64_t* const sums = sums_.data() + row * blocks_;
  const auto block = static_cast<size_t>(std::upper_bound(sums, sums + blocks_, at) - sums);
  uint64_t sum = block > 0 ? sums[block - 1] : 0;
  size_t light = block * kBlock;
  while ((sum += value(code(row, light))) <= at) ++light;
  return {light, prob(row, light)};
}

}  // namespace turbid
