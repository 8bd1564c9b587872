#pragma once
#include "core/rng.h"
#include "refraction/pencil.h"
#include "scene/scene.h"

namespace turbid {

/// A light chosen by its power, and a point on it (or a direction to it) that does not depend on who is lit.
class LightSample {
 public:
  /// Draws five numbers, rarely more. Empty where the scene has no light, or the light is a beam.
  static std::optional<LightSample> draw(const Scene& scene, Rng& rng);

  const LightPoint& point() const { return point_; }
  bool at_infinity() const { return point_.at_infinity; }
  Vec3 position() const { return emission_.origin; }

  /// What leaves the point in `direction` (unit, away from the light), over the probability of the choice: intensity
  /// per area, W/sr. Lights at infinity: irradiance across the direction, W/m^2.
  Spectrum emitted(const Vec3& direction) const;

 private:
  const Emitter* emitter_ = nullptr;
  LightPoint point_;
  EmissionSample emission_{};
  Spectrum irradiance_;  ///< of lights at infinity
  float inverse_prob_ = 1;
};

}  // namespace turbid
