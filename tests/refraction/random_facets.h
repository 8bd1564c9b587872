#pragma once
#include "core/rng.h"
#include "refraction/contour.h"

namespace turbid::testing {

/// Random triangles, lights and lines, such that light of the one comes through the other.
class RandomFacets {
 public:
  explicit RandomFacets(uint64_t seed) : rng_(seed) {}

  double uniform(double low, double high) { return low + (high - low) * rng_.next_double(); }
  V3d direction() {
    const double z = uniform(-1, 1), phi = uniform(0, 2 * std::numbers::pi), r = std::sqrt(1 - z * z);
    return {r * std::cos(phi), r * std::sin(phi), z};
  }

  /// A triangle about the origin whose front looks to +z; `bend`: by how much normals differ from the geometric one.
  Facet facet(double bend) {
    const V3d corners[] = {
        {-0.4, -0.3, uniform(-0.1, 0.1)}, {0.5, -0.2, uniform(-0.1, 0.1)}, {0, 0.5, uniform(-0.1, 0.1)}};
    Facet facet;
    facet.p0 = corners[0];
    facet.p_a = corners[1] - corners[0];
    facet.p_b = corners[2] - corners[0];
    const V3d across = facet.p_a.cross(facet.p_b);
    facet.area2 = across.length();
    facet.ng = across / facet.area2;
    const auto normal = [&] { return (facet.ng + direction() * bend).normalized() * uniform(0.5, 2); };
    facet.n0 = normal();
    facet.n_a = normal() - facet.n0;
    facet.n_b = normal() - facet.n0;
    return facet;
  }
  LightPoint light(bool at_infinity = false) {
    const V3d towards = V3d(uniform(-0.5, 0.5), uniform(-0.5, 0.5), 1).normalized();
    return {at_infinity ? towards : towards * uniform(0.5, 3), at_infinity};
  }
  double eta() { return uniform(0, 1) < 0.5 ? uniform(1.1, 1.8) : 1 / uniform(1.1, 1.8); }
  V2d inside() {
    const double a = uniform(0, 1), b = uniform(0, 1);
    return a + b < 1 ? V2d(a, b) : V2d(1 - a, 1 - b);
  }
  /// A line through a point of a ray, at t = t_there.
  Line line_through(const V3d& p, double t_there) {
    const V3d d = direction();
    return {p - d * t_there, d};
  }

 private:
  Rng rng_;
};

}  // namespace turbid::testing
