#pragma once
#include "core/frame.h"
#include "surface/two_sided.h"

namespace turbid {

/// How a material behind a bump or normal map behaves; both as in Mitsuba 3 (3.7.1 and later).
struct TiltSettings {
  /// A normal that faces away from the direction towards the sensor is mirrored about the shading normal, so that it
  /// faces it (Schuessler et al. 2017).
  bool flip_invalid_normals = true;
  /// Soften the edge of the shadow that the tilt casts (Estevez et al. 2019).
  bool use_shadowing_function = true;
};

/// A material seen through a tilted shading frame: bump and normal maps say how it is tilted.
///
/// With n the tilted normal, and primes for directions in its frame, radiance mode has
///   f_tilted(wo, wi) |cos wi| = f(wo', wi') |cos' wi| S(wi),
/// and nothing where a direction lies on different sides of the two normals. That is not symmetric, so importance mode
/// evaluates the adjoint, f_tilted(wo, wi) |cos wo|: the same f, times |cos wo / cos' wo| |cos' wi / cos wi| S(wi).
class Tilted : public Bsdf {
 public:
  /// A missing nested material is std::invalid_argument.
  Tilted(BsdfPtr nested, const TiltSettings& settings);

  lobe::Flags flags() const override { return nested_->flags(); }
  Eval eval(const SurfacePoint& point, const Vec3& given, const Vec3& chosen, TransportMode mode) const override;
  std::optional<BsdfSample> sample(const SurfacePoint& point, const Vec3& given, float u_lobe, const Vec2& u,
                                   TransportMode mode) const override;
  Spectrum null_transmission(const SurfacePoint& point, const Vec3& given) const override;
  Spectrum albedo(const SurfacePoint& point) const override { return nested_->albedo(point); }

 protected:
  /// The tilted normal in the local frame of the point; need not be unit. Zero or not finite: no tilt.
  virtual Vec3 tilt(const SurfacePoint& point) const = 0;

 private:
  struct Frames;
  Frames frames(const SurfacePoint& point) const;
  SurfacePoint tilted_point(const SurfacePoint& point, const Frame& frame) const;
  Eval importance(const SurfacePoint& point, const Frames& frames, const Vec3& given, const Vec3& chosen) const;
  float shadowing(const Vec3& normal, const Vec3& wi) const;

  BsdfPtr nested_;
  TiltSettings settings_;
};

}  // namespace turbid
