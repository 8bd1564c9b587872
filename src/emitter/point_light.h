#pragma once
#include "core/warp.h"
#include "emitter/emitter.h"

namespace turbid {

/// Shines the same intensity in every direction from one point. Mitsuba's `point`.
class PointLight final : public Emitter {
 public:
  /// Intensity in W/sr.
  PointLight(const Vec3& position, const Spectrum& intensity) : position_(position), intensity_(intensity) {}

  /// Empty only at the light itself.
  std::optional<DirectLightSample> sample_direct(const Vec3& from, const Vec2& u) const override;
  /// Uniform over the sphere of directions.
  std::optional<EmissionSample> sample_emission(const Vec2& u_position, const Vec2& u_direction) const override;
  EmissionPdf emission_pdf(const Vec3&, const Vec3&) const override { return {0, kUniformSpherePdfW}; }
  std::optional<Spectrum> emission_towards(const EmissionSample&, const Vec3&) const override { return intensity_; }
  bool can_be_hit() const override { return false; }
  Bounds3 bounds() const override { return Bounds3(position_); }
  Spectrum power() const override { return intensity_ * (4 * kPi); }

 private:
  Vec3 position_;
  Spectrum intensity_;
};

}  // namespace turbid
