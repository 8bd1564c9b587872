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
  /// Of these, the ones of this visit to the medium: since the walk came into it through a boundary, or left a light or
  /// an opaque surface in it. Reflection at a boundary that bends light does not end a visit (S1 sect. 3.1).
  int visit_order = 0;
};

/// Reflection at this surface does not end a visit to a medium: it bends light, and is no mere passage.
inline bool keeps_visit(const Bsdf& bsdf) {
  return bsdf.flags() & lobe::kTransmission && !(bsdf.flags() & lobe::kNull);
}

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
