#pragma once
#include "core/transform.h"
#include "texture/unit_cube.h"
#include "texture/volume.h"

namespace turbid {

/// The same value everywhere. As in Mitsuba 3 its bounds are the unit cube [0,1]^3 taken through `to_world`: that is as
/// far as a medium of this extinction reaches.
class ConstantVolume final : public Volume {
 public:
  explicit ConstantVolume(const Spectrum& value, const Transform& to_world = {})
      : value_(value), bounds_(bounds_of_unit_cube(to_world)) {}

  const Spectrum& value() const { return value_; }
  Spectrum eval(const Vec3&) const override { return value_; }
  ValueRange range(const Bounds3&) const override { return {value_, value_, value_}; }
  const Bounds3& bounds() const override { return bounds_; }

 private:
  Spectrum value_;
  Bounds3 bounds_;
};

}  // namespace turbid
