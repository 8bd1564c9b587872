#pragma once
#include "core/warp.h"
#include "emitter/emitter.h"

namespace turbid {

/// The same radiance from every direction at infinity. Mitsuba's `constant`.
class ConstantEnvironment final : public EnvironmentEmitter {
 public:
  /// Radiance in W/(sr m^2).
  explicit ConstantEnvironment(const Spectrum& radiance) : radiance_(radiance) {}

  /// Uniform over the sphere of directions.
  std::optional<DirectLightSample> sample_direct(const Vec3&, const Vec2& u) const override {
    return DirectLightSample{.wi = square_to_sphere(u),
                             .distance = kInfinity,
                             .position = Vec3(0),
                             .weight = radiance_ / kUniformSpherePdfW,
                             .pdf_w = kUniformSpherePdfW};
  }
  Spectrum Le(const Vec3&) const override { return radiance_; }
  float pdf_direct_w(const Vec3&) const override { return kUniformSpherePdfW; }
  /// From all directions, each through the disk of the scene's bounding sphere.
  Spectrum power() const override { return radiance_ * (4 * kPi * disk_area()); }

 private:
  Spectrum radiance_;
};

}  // namespace turbid
