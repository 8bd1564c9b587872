#pragma once
#include "core/transform.h"
#include "sensor/clip_range.h"
#include "sensor/sensor.h"

namespace turbid {

/// A pinhole. Mitsuba's `perspective`: in its own space it looks along +z, +y is up, +x points to the left of the
/// image.
class PerspectiveSensor final : public Sensor {
 public:
  /// `to_world` must keep lengths (a reflection is allowed); `x_fov` is the horizontal field of view in degrees (see
  /// horizontal_fov), `aspect` width / height. The principal point moves off the film's centre by the offset times the
  /// film's size; positive offsets shift the image to the left and up. Bad values: std::invalid_argument.
  PerspectiveSensor(const Transform& to_world, double x_fov, double aspect, const ClipRange& clip = {},
                    const Vec2& principal_point_offset = Vec2(0));

  /// The origin is the pinhole; clipping planes are turned into distances along the ray.
  SensorRay sample_ray(const Vec2& film, const Vec2& u_aperture) const override;
  std::optional<SensorConnection> connect(const Vec3& p, const Vec2& u_aperture) const override;
  std::optional<SensorConnection> connect_to_infinity(const Vec3& direction, const Vec2& u_aperture) const override;
  std::optional<Vec3> aperture_point(const Vec2&) const override { return origin_; }
  Vec3 position() const override { return origin_; }

 private:
  Vec3 origin_;
  Vec3 corner_, across_, down_;  ///< film (x, y) is seen along corner + x across + y down, 1 long along the axis
  ClipRange clip_;
};

}  // namespace turbid
