#include "image/splat_buffer.h"

#include <cmath>

namespace turbid {
namespace {

struct Choice {
  int pixel = 0;
  float weight = 0;
};

/// choose_pixel along one axis.
Choice choose_along_axis(const ReconstructionFilter& filter, float position, float u) {
  const float support = filter.support();
  const auto first = static_cast<int>(std::floor(position - support - 0.5f));
  const auto last = static_cast<int>(std::ceil(position + support - 0.5f));
  const auto density = [&](int pixel) { return filter.pdf_1d(position - (static_cast<float>(pixel) + 0.5f)); };
  float sum = 0;
  for (int pixel = first; pixel <= last; ++pixel) sum += density(pixel);
  float rest = u * sum;
  Choice result{first, sum};
  for (int pixel = first; pixel <= last; ++pixel) {
    const float own = density(pixel);
    if (own == 0) continue;
    result.pixel = pixel;  // rounding may leave a little: the last one with a density takes it
    if (rest < own) break;
    rest -= own;
  }
  return result;
}

}  // namespace

SplatBuffer::SplatBuffer(const Vec2i& size, int largest_exponent)
    : size_(size),
      scale_(std::ldexp(1.0, kFractionBits - largest_exponent)),
      unit_(std::ldexp(1.0, largest_exponent - kFractionBits)),
      cells_(static_cast<size_t>(size.x) * static_cast<size_t>(size.y) * kChannels) {}

void SplatBuffer::add(size_t pixel, const Spectrum& value) {
  constexpr double kLargest = double{1ull << (kFractionBits + kHeadroomBits)};
  for (int c = 0; c < kChannels; ++c) {
    double scaled = static_cast<double>(value[c]) * scale_;
    if (scaled > kLargest) {
      scaled = kLargest;
      saturated_.fetch_add(1, std::memory_order_relaxed);
    }
    const int64_t steps = std::llrint(scaled);
    if (steps != 0) cells_[pixel * kChannels + static_cast<size_t>(c)].fetch_add(steps, std::memory_order_relaxed);
  }
}

Spectrum SplatBuffer::sum(size_t pixel) const {
  Spectrum result;
  for (int c = 0; c < kChannels; ++c) {
    const int64_t steps = cells_[pixel * kChannels + static_cast<size_t>(c)].load(std::memory_order_relaxed);
    result[c] = static_cast<float>(static_cast<double>(steps) * unit_);
  }
  return result;
}

void SplatBuffer::clear() {
  for (auto& cell : cells_) cell.store(0, std::memory_order_relaxed);
}

SplatTarget choose_pixel(const ReconstructionFilter& filter, const Vec2& position, const Vec2& u) {
  const Choice x = choose_along_axis(filter, position.x, u.x), y = choose_along_axis(filter, position.y, u.y);
  return {{x.pixel, y.pixel}, x.weight * y.weight};
}

}  // namespace turbid
