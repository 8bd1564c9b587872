#pragma once
#include "surface/bsdf.h"

namespace turbid {

/// A boundary that light does not notice: where one medium ends and another begins.
class NullBsdf final : public Bsdf {
 public:
  lobe::Flags flags() const override { return lobe::kNull | lobe::kDelta | lobe::kTransmission; }
  Eval eval(const SurfacePoint&, const Vec3&, const Vec3&, TransportMode) const override { return {}; }
  std::optional<BsdfSample> sample(const SurfacePoint&, const Vec3& given, float, const Vec2&,
                                   TransportMode) const override {
    return BsdfSample{-given, Spectrum(1.0f), 0, flags(), 1};
  }
  Spectrum null_transmission(const SurfacePoint&, const Vec3&) const override { return Spectrum(1.0f); }
};

}  // namespace turbid
