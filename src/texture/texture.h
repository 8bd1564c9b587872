#pragma once
#include "core/spectrum.h"
#include "geometry/surface_point.h"

namespace turbid {

/// A quantity that varies over a surface: reflectance, roughness, radiance ... Immutable, shared between threads.
class Texture {
 public:
  virtual ~Texture() = default;
  virtual Spectrum eval(const SurfacePoint& point) const = 0;
  /// One number where a scalar is asked for: the luminance of eval() for a colour texture, the value for a grey one.
  virtual float eval_scalar(const SurfacePoint& point) const { return eval(point).luminance(); }
  /// Derivatives of eval_scalar() by u and v, for bump maps: 0 where the texture is constant in pieces.
  virtual Vec2 gradient(const SurfacePoint&) const { return {0, 0}; }
  /// Mean over the uv square (or an estimate), for light selection and reports.
  virtual Spectrum mean() const = 0;
  /// The same value everywhere: kernels may then skip the look-up's arguments.
  virtual bool is_constant() const { return false; }
  /// Largest value that eval() can return in any channel.
  virtual float max() const = 0;
};

}  // namespace turbid
