#pragma once
#include <span>

#include "table/lag_simulation.h"

namespace turbid {

/// How light falls off far from its source, where it is diffuse: exp(-k R)/R about a point ahead of the source, R the
/// distance from that, k the decay rate of transport (decay_rate). The point is where light of that albedo has its
/// centre: g / (1 - g albedo) from a collision, one mean free path more along a ray.
class FarField {
 public:
  FarField(std::span<const double> moments, double albedo, SourceKind kind);

  /// Rate k, per mean free path.
  double decay() const { return decay_; }
  /// The ring of cells from whose middles on a field of this albedo is continued so. 9 % of the energy lies beyond 4
  /// decay lengths. At high albedo the samples there are too few to keep; within 60 mean free paths they serve for half
  /// as far again. At low albedo light is not diffuse before it is gone: no far field within 20 mean free paths.
  int edge(const PolarGrid& grid) const;
  /// r T at one distance over r T at another, both in the direction with this cosine to the source's axis.
  float ratio(float to, float from, float cosine) const;

 private:
  double decay_;
  float centre_;
};

}  // namespace turbid
