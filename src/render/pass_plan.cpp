#include "render/pass_plan.h"

#include <algorithm>
#include <bit>

namespace turbid {
namespace {

constexpr uint64_t kSamplesOfAPass = uint64_t{1} << 19;
constexpr uint64_t kMostPerPixel = 64;

}  // namespace

uint32_t samples_per_pass(const Vec2i& size) {
  const uint64_t pixels = static_cast<uint64_t>(std::max(size.x, 1)) * static_cast<uint64_t>(std::max(size.y, 1));
  const uint64_t wanted = (kSamplesOfAPass + pixels - 1) / pixels;
  return static_cast<uint32_t>(std::bit_ceil(std::min(wanted, kMostPerPixel)));
}

PassPlan::PassPlan(const Vec2i& size, const Budget& budget, uint64_t seed)
    : per_pass_(turbid::samples_per_pass(size)), seed_(seed), target_(budget.samples) {
  if (budget.passes) target_ = std::min(target_.value_or(UINT64_MAX), *budget.passes * per_pass_);
}

PassPlan PassPlan::growing(const Budget& budget, uint64_t seed) {
  PassPlan plan({1, 1}, budget, seed);
  plan.grows_ = true;
  return plan;
}

std::optional<Pass> PassPlan::next(uint64_t samples) const {
  if (target_ && samples >= *target_) return std::nullopt;
  uint64_t count = per_pass_;
  if (grows_) {
    // A power of two that divides what there is.
    const uint64_t divisor = uint64_t{1} << std::countr_zero(samples | kMostPerPixel);
    count = std::min({count, divisor, std::bit_floor((samples / 32) | 1)});
  }
  if (target_) count = std::min(count, *target_ - samples);
  return Pass{seed_, samples, static_cast<uint32_t>(count)};
}

}  // namespace turbid
