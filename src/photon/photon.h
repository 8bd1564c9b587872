#pragma once
#include "gathering/gather_kernels.h"
#include "path/light_recorder.h"
#include "path/vertex.h"

namespace turbid {

/// Where a light path collided, or came to a surface with a smooth lobe.
struct PhotonPoint {
  Vec3 position;
  Vec3 direction;                  ///< of travel, unit
  Vec3 ng;                         ///< of surfaces: geometric normal
  Spectrum flux;                   ///< W; collisions: with the albedo
  const Medium* medium = nullptr;  ///< of collisions
  /// Parts of StrategyWeights::beside_merge, which is near + power(pdf_back_w) * far.
  double near = 0, far = 0;
  int depth = 0, order = 0;  ///< edges and collisions with the point
  bool bent = false;         ///< CountedLight::is_bent
  int visit_order = 0;       ///< PathState::visit_order

  PhotonPoint(const Vec3& p, const Vec3& travel, const PathState& state, const StrategyWeights& weights,
              const StrategySums& sums)
      : position(p),
        direction(travel),
        flux(state.throughput),
        near(weights.power(sums.inverse_pdf) * sums.joint),
        far(weights.power(sums.inverse_pdf) * sums.behind),
        depth(state.depth),
        order(state.order),
        visit_order(state.visit_order) {}

  double beside_merge(const StrategyWeights& weights, double pdf_back_w) const {
    return near + weights.power(pdf_back_w) * far;
  }
};

/// A flight of a light path through a homogeneous medium.
struct PhotonBeam {
  LightSegment segment;
  const HomogeneousMedium* medium;
  OpenEdge edge;             ///< that the flight is part of ...
  Spectrum straight;         ///< ... and what it lets through in front of the flight
  uint32_t emission = 0;     ///< of the light path, see PhotonMap
  int depth = 0, order = 0;  ///< edges and collisions before the flight
  bool bent = false;         ///< CountedLight::may_collide
  int visit_order = 0;       ///< PathState::visit_order

  const Ray& ray() const { return segment.ray; }
};

}  // namespace turbid
