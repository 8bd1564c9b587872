#pragma once
#include "core/ray.h"
#include "core/sampler.h"

namespace turbid {

/// A ray from the sensor. Attenuation counts from ray.origin; surfaces and collisions nearer than near_t or beyond
/// ray.t_max are clipped.
struct SensorRay {
  Ray ray;
  float near_t = 0;
  float weight = 1;  ///< factor of the radiance: 1 for the sensors that exist
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
  /// A point of the sensor, to find the medium that it stands in.
  virtual Vec3 position() const = 0;
};

}  // namespace turbid
