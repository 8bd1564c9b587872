#include "surface/blend.h"

#include <algorithm>
#include <stdexcept>

namespace turbid {

Blend::Blend(const TexturePtr& weight, BsdfPtr first, BsdfPtr second)
    : weight_(weight, 0.5f), first_(std::move(first)), second_(std::move(second)) {
  if (!first_ || !second_) throw std::invalid_argument("a blend needs two nested materials");
}

float Blend::weight(const SurfacePoint& point) const { return std::clamp(weight_.eval_scalar(point), 0.0f, 1.0f); }

Bsdf::Eval Blend::eval(const SurfacePoint& point, const Vec3& given, const Vec3& chosen, TransportMode mode) const {
  const float w = weight(point);
  Eval result;
  if (w < 1) result = first_->eval(point, given, chosen, mode);
  if (w == 0) return result;
  const Eval second = second_->eval(point, given, chosen, mode);
  return {lerp(result.value, second.value, w), std::lerp(result.pdf_w, second.pdf_w, w)};
}

std::optional<BsdfSample> Blend::sample(const SurfacePoint& point, const Vec3& given, float u_lobe, const Vec2& u,
                                        TransportMode mode) const {
  const float w = weight(point);
  const bool take_second = u_lobe < w;
  const Bsdf& taken = take_second ? *second_ : *first_;
  const Bsdf& other = take_second ? *first_ : *second_;
  const float prob = take_second ? w : 1 - w;
  constexpr float kBelowOne = 0x1.fffffep-1f;
  const float u_nested = std::min((take_second ? u_lobe : u_lobe - w) / prob, kBelowOne);
  std::optional<BsdfSample> result = taken.sample(point, given, u_nested, u, mode);
  // A delta lobe is sampled with `prob` times its own probability and counts with `prob` times its own factor.
  if (!result || (result->flags & lobe::kDelta) || prob == 1) return result;
  const Eval beside = other.eval(point, given, result->direction, mode);
  const float pdf_w = prob * result->pdf_w + (1 - prob) * beside.pdf_w;
  result->weight = (result->weight * (prob * result->pdf_w) + beside.value * (1 - prob)) / pdf_w;
  result->pdf_w = pdf_w;
  return result;
}

Spectrum Blend::null_transmission(const SurfacePoint& point, const Vec3& given) const {
  return lerp(first_->null_transmission(point, given), second_->null_transmission(point, given), weight(point));
}

Spectrum Blend::albedo(const SurfacePoint& point) const {
  return lerp(first_->albedo(point), second_->albedo(point), weight(point));
}

}  // namespace turbid
