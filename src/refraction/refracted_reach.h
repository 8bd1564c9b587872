#pragma once
#include <cstdint>

#include "refraction/contour.h"

namespace turbid {

/// Balls around eight sets of triangles and cones around their shading normals.
struct alignas(32) BoundedNormals {
  static constexpr int kLanes = 8;
  float center[3][kLanes];
  float radius[kLanes];
  float axis[3][kLanes];  ///< of the cone of normals, on the outside, unit
  float angle[kLanes];    ///< half opening of the cone, radians; pi: no bound
};

/// One light and one boundary, as the bounds need them.
struct RefractionQuery {
  RefractionQuery(const LightPoint& light_point, double index_ratio, bool light_inside);
  LightPoint light;
  double eta, inverse_eta;              ///< index where the refracted light goes / index at the light
  double sign;                          ///< of normals: -1 where the light stands on the inside
  double cos_deviation, sin_deviation;  ///< of the angle by which refraction bends light at most
};

/// Which of eight sets can refract light of one point into [from, to] of a line, and into which part of it: a little
/// more than that is true, never less. From ball and cone follows a cone of directions that all light of one point is
/// refracted into, and from that a shaft that it stays in (S4 sect. 3.2.4 asks for cones that can contain the
/// half-vector; going with the light keeps the line out of it until the end). Where cones are too wide, the spindle
/// test.
struct RefractedReach {
  uint32_t lanes;  ///< a bit for each
  alignas(64) double from[BoundedNormals::kLanes];
  alignas(64) double to[BoundedNormals::kLanes];
};
RefractedReach refracted_reach(const BoundedNormals& bounds, const RefractionQuery& query, const Line& line,
                               double from, double to);

}  // namespace turbid
