#pragma once
#include "emitter/emitter.h"

namespace turbid {

/// Parallel light from infinity. Mitsuba's `directional`.
class DirectionalLight final : public Emitter {
 public:
  /// The direction that the light travels in (any length but 0, else std::invalid_argument), and the irradiance on a
  /// surface across it, W/m^2.
  DirectionalLight(const Vec3& direction, const Spectrum& irradiance);

  void set_scene_bounds(const Vec3& center, float radius) override;
  std::optional<DirectLightSample> sample_direct(const Vec3& from, const Vec2& u) const override;
  std::optional<EmissionSample> sample_emission(const Vec2& u_position, const Vec2& u_direction) const override;
  EmissionPdf emission_pdf(const Vec3&, const Vec3&) const override { return {1 / (kPi * sqr(radius_)), 0}; }
  bool can_be_hit() const override { return false; }
  bool is_at_infinity() const override { return true; }
  /// Through the disk of the scene's bounding sphere.
  Spectrum power() const override { return irradiance_ * (kPi * sqr(radius_)); }

 private:
  Vec3 direction_;
  Spectrum irradiance_;
  Vec3 center_;
  float radius_ = 1;
};

}  // namespace turbid
