#include "surface/mask.h"

#include <algorithm>
#include <stdexcept>

namespace turbid {
namespace {
constexpr lobe::Flags kPassOn = lobe::kNull | lobe::kDelta | lobe::kTransmission;
}

Mask::Mask(const TexturePtr& opacity, BsdfPtr nested) : opacity_(opacity, 0.5f), nested_(std::move(nested)) {
  if (!nested_) throw std::invalid_argument("a mask needs a nested material");
}

lobe::Flags Mask::flags() const { return nested_->flags() | kPassOn; }

float Mask::opacity(const SurfacePoint& point) const { return std::clamp(opacity_.eval_scalar(point), 0.0f, 1.0f); }

Bsdf::Eval Mask::eval(const SurfacePoint& point, const Vec3& given, const Vec3& chosen, TransportMode mode) const {
  const float weight = opacity(point);
  const Eval nested = nested_->eval(point, given, chosen, mode);
  return {nested.value * weight, nested.pdf_w * weight};
}

std::optional<BsdfSample> Mask::sample(const SurfacePoint& point, const Vec3& given, float u_lobe, const Vec2& u,
                                       TransportMode mode) const {
  const float weight = opacity(point);
  if (u_lobe >= weight) return BsdfSample{-given, Spectrum(1.0f), 0, kPassOn, 1};
  constexpr float kBelowOne = 0x1.fffffep-1f;
  std::optional<BsdfSample> result = nested_->sample(point, given, std::min(u_lobe / weight, kBelowOne), u, mode);
  if (result) result->pdf_w *= weight;
  return result;
}

Spectrum Mask::null_transmission(const SurfacePoint& point, const Vec3& given) const {
  const Spectrum one(1.0f);
  return one - (one - nested_->null_transmission(point, given)) * opacity(point);
}

Spectrum Mask::albedo(const SurfacePoint& point) const { return nested_->albedo(point) * opacity(point); }

}  // namespace turbid
