#pragma once
#include "scene/scene.h"

namespace turbid {

/// Where on its path a walk is: edges and collisions behind it, and what it carries. An estimator that joins a vertex
/// with something else adds its own.
struct PathState {
  /// From a light: flux, W. From the sensor: the factor of the radiance found here. At a vertex it holds all but the
  /// vertex's own scattering (a collision's albedo is in it).
  Spectrum throughput;
  int depth;  ///< edges behind
  int order;  ///< collisions in media behind, with this one
};

/// A surface that a walk has arrived at.
struct SurfaceEvent {
  const Object& object;
  const SurfacePoint& point;
  Vec3 given;        ///< unit, to where the walk comes from
  Vec3 given_local;  ///< the same in the shading frame
};

/// A collision that a walk scatters in.
struct CollisionEvent {
  Vec3 position;
  Vec3 direction;  ///< of the walk before, unit
  const Medium& medium;
};

}  // namespace turbid
