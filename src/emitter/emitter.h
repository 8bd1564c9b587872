#pragma once
#include <optional>

#include "core/ray.h"
#include "core/spectrum.h"
#include "geometry/shape.h"

namespace turbid {

/// A direction towards a light, chosen by an emitter for next-event estimation.
struct DirectLightSample {
  Vec3 wi;             ///< unit, from the receiving point towards the light
  float distance = 0;  ///< to the point on the light; infinite for lights at infinity
  Vec3 position;       ///< the point on the light (undefined for lights at infinity)
  Spectrum weight;     ///< Le / pdf_w for lights with area, or intensity / distance^2 (irradiance) for delta lights
  float pdf_w = 0;     ///< 1/sr at the receiving point; 0 when delta is true
  bool delta = false;  ///< point, spot, directional: no other technique can find it
};

/// A source of light. Immutable after `set_scene_bounds`, shared between threads.
class Emitter {
 public:
  virtual ~Emitter() = default;

  /// Lights at infinity learn the bounding sphere of the scene before rendering.
  virtual void set_scene_bounds(const Vec3& /*center*/, float /*radius*/) {}

  /// Chooses a direction to this light from `from`; takes two numbers.
  virtual std::optional<DirectLightSample> sample_direct(const Vec3& from, const Vec2& u) const = 0;

  /// Can a ray meet it by chance? False for delta lights.
  virtual bool can_be_hit() const = 0;
  /// A box around every point that light starts from; infinite (the default) for lights at infinity.
  virtual Bounds3 bounds() const { return Bounds3(Vec3(-kInfinity), Vec3(kInfinity)); }

  /// At infinity: seen by rays that leave the scene.
  virtual bool is_environment() const { return false; }
  /// Environment and directional lights: no straight line from inside a closed boundary meets them.
  virtual bool is_at_infinity() const { return is_environment(); }

  /// Power estimate in W (per channel), used to choose among lights; environment lights: through the scene's disk.
  virtual Spectrum power() const = 0;
};

/// Light at infinity: constant, environment map.
class EnvironmentEmitter : public Emitter {
 public:
  /// Radiance that arrives from `direction` (unit, pointing away from the scene).
  virtual Spectrum Le(const Vec3& direction) const = 0;
  /// Density of sample_direct, 1/sr.
  virtual float pdf_direct_w(const Vec3& direction) const = 0;
  bool can_be_hit() const final { return true; }
  bool is_environment() const final { return true; }
};

/// A surface that shines: one-sided, on the outside of its shape.
class SurfaceEmitter : public Emitter {
 public:
  /// Radiance leaving `point` in direction `w` (unit, away from the surface), W/(sr m^2); 0 on the inside.
  virtual Spectrum Le(const SurfacePoint& point, const Vec3& w) const = 0;
  /// Density with which sample_direct(from) chooses `point`, 1/sr at `from`.
  virtual float pdf_direct_w(const Vec3& from, const SurfacePoint& point) const = 0;
  bool can_be_hit() const final { return true; }
};

}  // namespace turbid
