#pragma once
#include <memory>

#include "core/transform.h"
#include "emitter/emitter.h"
#include "texture/texture.h"

namespace turbid {

/// A point light that shines into a cone about its local +z axis: full intensity within `beam_width` of the axis, then
/// falling linearly with the angle to 0 at `cutoff_angle`. Mitsuba's `spot`.
class SpotLight final : public Emitter {
 public:
  /// Intensity in W/sr, angles in degrees from the axis, 0 <= beam_width <= cutoff_angle <= 180, cutoff_angle > 0.
  /// The texture (may be null) is projected: local directions (x, y, z) look it up at uv = (x, y) / (2 z tan(cutoff)) +
  /// 1/2; it multiplies the intensity and needs cutoff_angle < 90. Else std::invalid_argument.
  SpotLight(const Transform& to_world, const Spectrum& intensity, float cutoff_angle, float beam_width,
            std::shared_ptr<const Texture> texture = nullptr);

  /// Empty outside the cone.
  std::optional<DirectLightSample> sample_direct(const Vec3& from, const Vec2& u) const override;
  /// Uniform over the cone.
  std::optional<EmissionSample> sample_emission(const Vec2& u_position, const Vec2& u_direction) const override;
  EmissionPdf emission_pdf(const Vec3& ng, const Vec3& direction) const override;
  std::optional<Spectrum> emission_towards(const EmissionSample&, const Vec3& direction) const override {
    return intensity(direction);
  }
  Cone cone() const override { return {axis_.n, static_cast<double>(cutoff_)}; }
  bool can_be_hit() const override { return false; }
  Bounds3 bounds() const override { return Bounds3(position_); }
  /// Exact without a texture; with one, its mean stands for it.
  Spectrum power() const override;

  /// Intensity towards a world direction that points away from the light (unit), W/sr.
  Spectrum intensity(const Vec3& direction) const;

 private:
  Transform to_local_;
  Vec3 position_;
  Frame axis_;  ///< n along the axis of the cone
  Spectrum intensity_;
  float cutoff_, beam_;  ///< radians
  float cos_cutoff_, cos_beam_, inverse_transition_, tan_cutoff_;
  std::shared_ptr<const Texture> texture_;
};

}  // namespace turbid
