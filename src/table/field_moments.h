#pragma once
#include <functional>

#include "table/lobe_field.h"

namespace turbid {

/// The first moments of a light field about its source; distances in mean free paths.
struct FieldMoments {
  double energy = 0;  ///< int of the source radiance over directions and all space
  double along = 0;   ///< mean of z, along the source's axis
  double square = 0;  ///< mean of the squared distance
};

/// By quadrature over places.
FieldMoments measure_moments(const LobeField& field);

/// Of light of order from_order and more, in closed form (NUMERICS 8): n collisions have the energy albedo^n and, with
/// a mean cosine g, after k flights E[z] = g (1 - g^k) / (1 - g) from a collision, (1 - g^k) / (1 - g) along a ray, and
/// E[r^2] = 2 k + 2 g (k (1 - g) - (1 - g^k)) / (1 - g)^2 from both.
FieldMoments exact_moments(double g, double albedo, SourceKind kind, int from_order = 3);

/// How far two fields are apart: root of the mean over a grid's cells, weighed by their energy in `a`, of the squared
/// difference over the mean of both squares. Looked at alternately in the middle and at the corner of cells.
struct LobeDifference {
  double lobes = 0;    ///< over directions
  double density = 0;  ///< over all directions together
  double shape = 0;    ///< over directions, of lobes that are made equal in density
};
/// In one place: x from the source, whose axis is z; off that.
LobeDifference compare_lobes_at(const LightField& a, const LightField& b, const Vec3& x);
/// `counts`: of a place, whether it does.
LobeDifference compare_lobes(const LightField& a, const LightField& b, const PolarGrid& grid,
                             const std::function<bool(const Vec3&)>& counts = {});

}  // namespace turbid
