#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "manylight/light_sampler.h"

namespace turbid {

/// Many distributions over the same lights, a row each, in about one byte per light. A weight is kept as the exponent
/// of a power of 2^(1/12), 6 % apart, below the largest of its row; what is more than 21 octaves below counts as 0. The
/// rounded weights are whole numbers and define the distribution: sample() and prob() agree exactly.
class CompactDistributions {
 public:
  CompactDistributions() = default;
  CompactDistributions(size_t rows, size_t lights);

  size_t rows() const { return totals_.size(); }
  /// Weights of a row, not negative. Different rows may be set by different threads.
  void set(size_t row, std::span<const float> weights);
  /// All weights of the row are 0: nothing to sample.
  bool is_empty(size_t row) const { return totals_[row] == 0; }

  /// Takes a number in [0, 1); only where the row is not empty.
  LightChoice sample(size_t row, double u) const;
  /// 0 in empty rows.
  double prob(size_t row, size_t light) const {
    return static_cast<double>(kValues[code(row, light)]) * inverse_totals_[row];
  }
  /// Adds `factor` times the probabilities of lights [first, first + sums.size()) to sums.
  void add_probs(size_t row, double factor, size_t first, std::span<float> sums) const;

  size_t bytes() const { return bytes_for(rows(), lights_); }
  static size_t bytes_for(size_t rows, size_t lights);

 private:
  static constexpr size_t kBlock = 64;  ///< lights under one partial sum
  void clear(size_t row);
  static size_t blocks_of(size_t lights) { return (lights + kBlock - 1) / kBlock; }
  static const std::array<uint64_t, 256> kValues;  ///< by code
  uint8_t code(size_t row, size_t light) const { return codes_[row * lights_ + light]; }

  size_t lights_ = 0, blocks_ = 0;
  std::vector<uint8_t> codes_;
  std::vector<uint64_t> sums_;  ///< of the values before the end of each block
  std::vector<uint64_t> totals_;
  std::vector<double> inverse_totals_;
};

}  // namespace turbid
