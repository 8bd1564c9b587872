#pragma once
#include <cstddef>

#include "core/vector.h"

namespace turbid {

/// From where light sets out.
enum class SourceKind {
  kCollision,  ///< a photon collides at the origin, having travelled along +z
  kRay         ///< a photon sets out from the origin along +z, unscattered, and collides where it may
};
inline constexpr size_t kSourceKinds = 2;

/// Light of several scatterings around a source in an infinite medium of one albedo, mean free path 1, that looks the
/// same from all sides of the source's axis: however it is stored.
class LightField {
 public:
  virtual ~LightField() = default;

  /// The source radiance at x (from the source), whose axis (the direction of its light) is `axis`, towards w: what
  /// leaves the last collisions there, 1/sr per cubic mean free path and unit of flux. Never negative.
  virtual float eval(const Vec3& x, const Vec3& axis, const Vec3& w) const = 0;

  /// int over the sphere of eval over w: the density of last collisions times the albedo, per cubic mean free path.
  virtual float density(const Vec3& x, const Vec3& axis) const = 0;
};

}  // namespace turbid
