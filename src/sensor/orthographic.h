#pragma once
#include "core/transform.h"
#include "sensor/clip_range.h"
#include "sensor/sensor.h"

namespace turbid {

/// Parallel rays along +z of its own space, through a film that spans x in [-1, 1] (+x to the left of the image) and
/// y in [-1, 1] / aspect; to_world may scale it. Mitsuba's `orthographic`.
class OrthographicSensor final : public Sensor {
 public:
  /// Bad values: std::invalid_argument.
  OrthographicSensor(const Transform& to_world, double aspect, const ClipRange& clip = {});

  /// The origin lies on the plane z = 0 of the sensor's space.
  SensorRay sample_ray(const Vec2& film, const Vec2& u_aperture) const override;
  std::optional<SensorConnection> connect(const Vec3& p, const Vec2& u_aperture) const override;
  /// Always empty.
  std::optional<SensorConnection> connect_to_infinity(const Vec3&, const Vec2&) const override { return std::nullopt; }
  std::optional<Vec3> aperture_point(const Vec2&) const override { return std::nullopt; }
  /// The middle of the film.
  Vec3 position() const override { return corner_ + (across_ + down_) * 0.5f; }

 private:
  Vec3 corner_, across_, down_;  ///< film (x, y) starts at corner + x across + y down
  Vec3 direction_;
  float near_t_, far_t_;
};

}  // namespace turbid
