#pragma once
#include <array>

#include "refraction/facet.h"

namespace turbid {

inline bool signs_differ(double a, double b) { return (a < 0) != (b < 0); }

/// The six Bernstein coefficients of a quadratic function on a triangle tell bounds of it and of its gradient.
struct Quadratic {
  std::array<double, 3> corner;  ///< values at the corners 0, 1, 2
  std::array<double, 3> side;    ///< coefficients of the sides 01, 12, 20
  std::array<double, 3> bend;    ///< by how much those differ from the mean of their corners

  Quadratic(const std::array<double, 3>& corners, const std::array<double, 3>& middles) : corner(corners) {
    for (size_t k = 0; k < 3; ++k) {
      const double mean = (corners[k] + corners[(k + 1) % 3]) / 2;
      side[k] = 2 * middles[k] - mean;
      bend[k] = side[k] - mean;
    }
  }

  static constexpr double kShareOfBend = 0.15;
  /// The coefficient of a side, moved towards a sign change by a share of its bend: what a quadratic leaves out.
  double cautious(size_t k, double sign) const { return sign * side[k] - kShareOfBend * std::abs(bend[k]); }

  /// Of one sign everywhere, as far as can be told.
  bool keeps_its_sign() const {
    const double sign = corner[0] < 0 ? -1 : 1;
    for (size_t k = 0; k < 3; ++k)
      if (!(sign * corner[k] > 0) || !(cautious(k, sign) > 0)) return false;
    return true;
  }

  /// A side whose ends have the same sign may be crossed twice.
  bool may_cross_a_side_twice() const {
    for (size_t k = 0; k < 3; ++k) {
      const double a = corner[k], b = corner[(k + 1) % 3];
      if (signs_differ(a, b)) continue;
      const double c = cautious(k, a < 0 ? -1 : 1);
      if (c < 0 && c * c > a * b) return true;
    }
    return false;
  }

  /// Gradients at the corners by local coordinates along the sides 01 and 02; those in between are their means.
  std::array<V2d, 3> gradients() const {
    return {V2d(side[0] - corner[0], side[2] - corner[0]) * 2, V2d(corner[1] - side[0], side[1] - side[0]) * 2,
            V2d(side[1] - side[2], corner[2] - side[2]) * 2};
  }
};

}  // namespace turbid
