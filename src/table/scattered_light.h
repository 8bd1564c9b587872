#pragma once
#include <array>
#include <memory>

#include "core/spectrum.h"
#include "medium/homogeneous.h"
#include "table/lobe_field.h"

namespace turbid {

/// What a colour channel of MultipleScattering asks of a table, in whatever form the table keeps its light: multiple
/// scattering of two kinds of light in an infinite medium of one albedo, mean free path 1. Source radiance, 1/sr per
/// cubic mean free path and unit of flux.
class ScatteredLight {
 public:
  virtual ~ScatteredLight() = default;
  /// At x from where light collides that travelled along the unit vector `axis`, towards w.
  virtual float from_collision(const Vec3& x, const Vec3& axis, const Vec3& w) const = 0;
  /// At x from where light sets out along `axis`, to collide within `depth` > 0 mean free paths (which may be
  /// infinite). May be below 0 by noise.
  virtual float from_stretch(const Vec3& x, const Vec3& axis, float depth, const Vec3& w) const = 0;

  /// The same at eight places.
  virtual Lanes from_collision(const Vec3Lanes& x, const Vec3& axis, const Vec3& w) const = 0;
  virtual Lanes from_stretch(const Vec3Lanes& x, const Vec3& axis, float depth, const Vec3& w) const = 0;
};

/// One for each channel; null: the channel is black.
using ChannelLights = std::array<std::shared_ptr<const ScatteredLight>, kChannels>;

/// Light of a medium by fields of spherical harmonics (mode `exact`). Stretches by one look-up when they are
/// half-infinite or shorter than 0.2 mean free paths, three when shorter than 1, else two. Channels of one albedo share
/// theirs. Throws std::invalid_argument as LobeField does.
ChannelLights exact_lights(const HomogeneousMedium& medium, const ScatteringTable& table, int from_order = 3);

/// int_0^depth e^-t r(x - t axis) dt of a short stretch, r the light of collisions at a place: by one collision in
/// their mean depth below 0.2, else by three.
template <class Vector, class Collision>
auto collisions_of_stretch(float depth, const Vector& x, const Vector& axis, const Collision& collision) {
  const float collided = -std::expm1(-depth);
  using Real = decltype(collision(x));
  if (depth < 0.2f) {
    const float mean_depth = depth < 1e-2f ? depth / 2 : 1 - depth * std::exp(-depth) / collided;
    return collided * collision(x - axis * Real(mean_depth));
  }
  // Gauss-Legendre in the probability to have collided.
  Real sum(0.0f);
  for (const auto& [node, weight] : {std::pair{0.1127017f, 5.0f / 18}, {0.5f, 8.0f / 18}, {0.8872983f, 5.0f / 18}})
    sum += weight * collision(x + axis * Real(std::log1p(-node * collided)));
  return collided * sum;
}

}  // namespace turbid
