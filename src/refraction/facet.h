#pragma once
#include <Imath/ImathVec.h>

#include <cmath>

#include "geometry/triangle_mesh.h"

namespace turbid {

using Imath::V2d;
using Imath::V3d;

/// v / |v|, without Imath's care for the tiniest lengths.
inline V3d unit(const V3d& v) { return v * (1 / std::sqrt(v.length2())); }

/// One triangle of a mesh as refraction sees it, in double precision: positions and shading normals are linear in the
/// barycentric coordinates (a, b), which may lie outside of the triangle.
struct Facet {
  V3d p0{0}, p_a{0}, p_b{0};  ///< P(a, b) = p0 + a p_a + b p_b
  V3d n0{0}, n_a{0}, n_b{0};  ///< n(a, b) = n0 + a n_a + b n_b, not normalised; on the outside
  V3d ng{0};                  ///< geometric normal, unit, on the outside
  double area2 = 0;           ///< twice the area: dA_P = area2 da db

  V3d position(const V2d& at) const { return p0 + p_a * at.x + p_b * at.y; }
  V3d blended_normal(const V2d& at) const { return n0 + n_a * at.x + n_b * at.y; }
  V3d normal(const V2d& at) const { return unit(blended_normal(at)); }
  /// Derivative of normal() along the direction `da_db`, where the blend is `blended`.
  static V3d normal_change(const V3d& blended, const V3d& change) {
    const double scale = 1 / std::sqrt(blended.length2());
    const V3d n = blended * scale;
    return (change - n * n.dot(change)) * scale;
  }

  /// The same triangle with its inside taken for its outside.
  Facet flipped() const {
    Facet result = *this;
    result.n0 = -n0;
    result.n_a = -n_a;
    result.n_b = -n_b;
    result.ng = -ng;
    return result;
  }
};

inline bool inside_triangle(const V2d& at, double slack = 0) {
  return at.x >= -slack && at.y >= -slack && at.x + at.y <= 1 + slack;
}

/// The triangle with the normals that TriangleMesh shades with: facets where there are none.
Facet facet_of(const TriangleMesh& mesh, uint32_t triangle);

/// TriangleMesh shades with the blend of the vertex normals here, and not with one that it bent to the front of the
/// geometric normal.
bool shades_with_blend(const Facet& facet, const V2d& at);

}  // namespace turbid
