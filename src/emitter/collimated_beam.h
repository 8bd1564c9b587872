#pragma once
#include "core/frame.h"
#include "core/transform.h"
#include "emitter/emitter.h"

namespace turbid {

/// A laser: parallel light along +z of its own space from the disk z = 0 around its origin, alike over the disk. No
/// point in space has a direction towards it that could be asked for: only paths from the light find what it lights.
class CollimatedBeam final : public Emitter {
 public:
  /// Power in W; the radius (scene units, 0: a single ray) is not scaled by to_world. A negative or infinite radius is
  /// std::invalid_argument.
  CollimatedBeam(const Transform& to_world, const Spectrum& power, float radius);

  /// Always empty.
  std::optional<DirectLightSample> sample_direct(const Vec3&, const Vec2&) const override { return std::nullopt; }
  /// Uniform over the disk.
  std::optional<EmissionSample> sample_emission(const Vec2& u_position, const Vec2& u_direction) const override;
  EmissionPdf emission_pdf(const Vec3&, const Vec3&) const override;
  bool can_be_hit() const override { return false; }
  bool can_be_aimed_at() const override { return false; }
  Bounds3 bounds() const override;
  Spectrum power() const override { return power_; }

 private:
  Vec3 center_;
  Frame axis_;  ///< n along the beam
  Spectrum power_;
  float radius_;
};

}  // namespace turbid
