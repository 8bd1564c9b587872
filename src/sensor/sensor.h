#pragma once
#include <optional>

#include "core/ray.h"
#include "core/sampler.h"

namespace turbid {

/// A ray from the sensor. Attenuation counts from ray.origin; surfaces and collisions nearer than near_t or beyond
/// ray.t_max are clipped.
struct SensorRay {
  Ray ray;
  float near_t = 0;
  float weight = 1;             ///< factor of the radiance: 1 for the sensors that exist
  Vec2 u_aperture{0.5f, 0.5f};  ///< the numbers that chose its origin
};

/// How light that sets out from some point, or from infinity, reaches the sensor.
struct SensorConnection {
  Vec3 position;  ///< on the aperture
  /// Where on the film it arrives; may lie outside [0,1]^2, where the reconstruction filter of pixels at the border
  /// still looks.
  Vec2 film;
  /// Density of film area per unit of what arrives: the mean over the film of a picture is the integral of radiance
  /// times this. From a point: 1/area across the direction there (1/(A cos^3 theta d^2) for a film that has area A when
  /// projected through the aperture to distance 1 along the axis). From infinity: 1/sr.
  float importance = 0;
  float near_t = 0, far_t = kInfinity;  ///< distances from `position` between which things are visible
};

/// Where pictures are taken from. Film coordinates are in [0,1]^2 over the whole (uncropped) film, x to the right, y
/// down. Immutable, shared between threads.
class Sensor {
 public:
  virtual ~Sensor() = default;
  /// Takes two numbers for the aperture (ignored by sensors without one).
  virtual SensorRay sample_ray(const Vec2& film, const Vec2& u_aperture) const = 0;
  /// True when sample_ray uses u_aperture.
  virtual bool needs_aperture() const { return false; }

  /// The way from `p` to the aperture, at a point drawn uniformly from it with the two numbers: the light of p arrives
  /// from there alone. Empty where no place of the film, however large, looks at p, and where p is clipped.
  virtual std::optional<SensorConnection> connect(const Vec3& p, const Vec2& u_aperture) const = 0;
  /// The same for light from infinity, which arrives from `direction` (unit, away from the sensor). Also empty for
  /// sensors that look in one direction only: no other direction has a density.
  virtual std::optional<SensorConnection> connect_to_infinity(const Vec3& direction, const Vec2& u_aperture) const = 0;

  /// The point of the aperture that the two numbers stand for, the same that connect() finds with them. Empty where
  /// that depends on who asks: the sensor has no aperture, and looks from everywhere in one direction.
  virtual std::optional<Vec3> aperture_point(const Vec2& u_aperture) const = 0;

  /// A point of the sensor, to find the medium that it stands in.
  virtual Vec3 position() const = 0;
};

}  // namespace turbid
