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
};

/// One for each channel; null: the channel is black.
using ChannelLights = std::array<std::shared_ptr<const ScatteredLight>, kChannels>;

/// Light of a medium by fields of spherical harmonics (mode `exact`). Stretches by one look-up when they are
/// half-infinite or shorter than 0.2 mean free paths, three when shorter than 1, else two. Channels of one albedo share
/// theirs. Throws std::invalid_argument as LobeField does.
ChannelLights exact_lights(const HomogeneousMedium& medium, const ScatteringTable& table, int from_order = 3);

/// int_0^depth e^-t r(x - t axis, w) dt of a short stretch, r the light of collisions: by one collision in their mean
/// depth below 0.2, else by three.
float collisions_of_stretch(const LightField& collision, float depth, const Vec3& x, const Vec3& axis, const Vec3& w);

}  // namespace turbid
