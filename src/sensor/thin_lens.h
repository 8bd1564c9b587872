#pragma once
#include "core/transform.h"
#include "sensor/clip_range.h"
#include "sensor/sensor.h"

namespace turbid {

/// A perspective sensor whose aperture is a disk: what lies on the plane at focus_distance is sharp. Mitsuba's
/// `thinlens`.
class ThinLensSensor final : public Sensor {
 public:
  /// As PerspectiveSensor; aperture_radius >= 0 and focus_distance > 0 (along the axis) in scene units.
  ThinLensSensor(const Transform& to_world, double x_fov, double aspect, float aperture_radius, float focus_distance,
                 const ClipRange& clip = {});

  /// The origin is a point of the lens.
  SensorRay sample_ray(const Vec2& film, const Vec2& u_aperture) const override;
  std::optional<SensorConnection> connect(const Vec3& p, const Vec2& u_aperture) const override;
  std::optional<SensorConnection> connect_to_infinity(const Vec3& direction, const Vec2& u_aperture) const override;
  std::optional<Vec3> aperture_point(const Vec2& u_aperture) const override {
    return origin_ + lens_offset(u_aperture);
  }
  bool needs_aperture() const override { return true; }
  /// The centre of the lens.
  Vec3 position() const override { return origin_; }

 private:
  /// The point of the lens that u stands for, from its centre.
  Vec3 lens_offset(const Vec2& u) const;

  Vec3 origin_;
  Vec3 corner_, across_, down_;  ///< as in PerspectiveSensor
  Vec3 lens_x_, lens_y_;         ///< radii of the lens
  float focus_distance_;
  ClipRange clip_;
};

}  // namespace turbid
