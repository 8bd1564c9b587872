#pragma once
#include <embree3/rtcore.h>

#include "geometry/instance.h"

namespace turbid {

/// A bounding-volume hierarchy of a group's members and one place where it stands: an Embree geometry of one primitive.
///
/// Embree's own instances invert the placement in float, which moves what they show by an error that grows with the
/// condition of the matrix. Here rays are taken to the group in double precision and rounded once, so that the error
/// bound of SurfacePoint::leave stays as small as it is for shapes that stand in the world.
struct PlacedTree {
  const GroupPlacement* placement;
  RTCScene members;  ///< geometry i is member i; owned by the RayCaster

  RTCGeometry make_embree_geometry(RTCDevice device) const;
};

}  // namespace turbid
