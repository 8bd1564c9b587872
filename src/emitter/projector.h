#pragma once
#include <memory>

#include "core/transform.h"
#include "emitter/emitter.h"
#include "texture/texture.h"

namespace turbid {

/// A slide projector: a pinhole at its origin that throws a picture along +z, +y up, the picture's first row on top.
/// Mitsuba 3's `projector`: on a plane across the axis at distance 1 the irradiance is pi times the picture (a white
/// diffuse screen there shows the picture itself), constant over the plane for a constant picture.
class Projector final : public Emitter {
 public:
  /// `x_fov`: of the picture's width, degrees, in (0, 180); `aspect`: width / height, > 0; to_world must keep lengths.
  /// Else std::invalid_argument, as for a missing picture.
  Projector(const Transform& to_world, std::shared_ptr<const Texture> irradiance, float scale, double x_fov,
            double aspect);

  /// Empty outside the picture.
  std::optional<DirectLightSample> sample_direct(const Vec3& from, const Vec2& u) const override;
  /// Uniform over the picture.
  std::optional<EmissionSample> sample_emission(const Vec2& u_position, const Vec2& u_direction) const override;
  EmissionPdf emission_pdf(const Vec3& ng, const Vec3& direction) const override;
  std::optional<Spectrum> emission_towards(const EmissionSample&, const Vec3& direction) const override {
    return intensity(direction);
  }
  Cone cone() const override {
    return {normalize(to_world_.vector({0, 0, 1})),
            std::atan(std::hypot(static_cast<double>(half_width_), static_cast<double>(half_height_))) + 1e-5};
  }
  bool can_be_hit() const override { return false; }
  Bounds3 bounds() const override { return Bounds3(position_); }
  /// Exact for a picture's true mean.
  Spectrum power() const override;

  /// Intensity towards a world direction that points away from the light (unit), W/sr:
  /// pi scale E(u, v) / cos^3.
  Spectrum intensity(const Vec3& direction) const;

 private:
  Transform to_world_, to_local_;
  Vec3 position_;
  std::shared_ptr<const Texture> irradiance_;
  float scale_;
  float half_width_, half_height_;  ///< of the picture at distance 1
};

}  // namespace turbid
