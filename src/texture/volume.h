#pragma once
#include "core/spectrum.h"
#include "core/vector.h"

namespace turbid {

/// What a volume is worth inside a box, per channel: no value there is below `min` or above `max`; `mean` is about the
/// average (it may come from coarser data).
struct ValueRange {
  Spectrum min, max, mean;
};

/// A quantity that varies in space: extinction, albedo, emission, temperature ... Points are in world space. Immutable,
/// shared between threads.
class Volume {
 public:
  virtual ~Volume() = default;

  /// The value at p. Outside of bounds() the volume still answers (how, the class says), but means nothing: whoever
  /// fills space with it stops there.
  virtual Spectrum eval(const Vec3& p) const = 0;

  /// Bounds on what eval() returns within the box. They are for majorants: `max` may be loose, never too small.
  virtual ValueRange range(const Bounds3& box) const = 0;

  /// World-space box that holds the volume; finite and not empty.
  virtual const Bounds3& bounds() const = 0;

  /// How many steps of the data lie along each axis of bounds(): what it takes to resolve them, at least 1.
  virtual Vec3 resolution() const { return Vec3(1); }
};

}  // namespace turbid
