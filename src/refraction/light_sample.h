#pragma once
#include "core/rng.h"
#include "refraction/pencil.h"
#include "scene/scene.h"

namespace turbid {

/// A point on a light, or a direction to it, that does not depend on who is lit.
class LightSample {
 public:
  /// `prob`: with which the light was chosen. Draws four numbers, rarely more. Empty for beams.
  static std::optional<LightSample> draw(const Scene& scene, const Emitter& emitter, float prob, Rng& rng);

  const LightPoint& point() const { return point_; }
  bool at_infinity() const { return point_.at_infinity; }
  Vec3 position() const { return emission_.origin; }

  /// What leaves the point in `direction` (unit, away from the light), over the probability of the choice: intensity
  /// per area, W/sr; lights at infinity: irradiance across the direction, W/m^2.
  Spectrum emitted(const Vec3& direction) const;

 private:
  const Emitter* emitter_ = nullptr;
  LightPoint point_;
  EmissionSample emission_{};
  Spectrum irradiance_;  ///< of lights at infinity
  float inverse_prob_ = 1;
};

}  // namespace turbid
