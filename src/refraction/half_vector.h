#pragma once
#include <array>
#include <optional>

#include "refraction/pencil.h"

namespace turbid {

/// The half-vector function of refraction (S4 eq. 1-7), whose zeros are the paths L -> P -> V(t) that obey Snell's law
/// at the shading normal: f(t, a, b) = H / |H| + sign(eta - 1) N with H = eta w_V + w_L; w_V and w_L are the unit
/// vectors from P to V and to the light, N points to the light's side, eta = index at V / index at the light, not 1.
/// (S4 writes the case eta > 1.)
class HalfVector {
 public:
  HalfVector(const Facet& facet, const LightPoint& light, double eta, const Line& line)
      : facet_(facet), light_(light), line_(line), eta_(eta), sign_(eta > 1 ? 1 : -1) {}

  V3d value(double t, const V2d& at) const;

  /// The value, and its derivatives by t, a and b (S4 eq. 14-15).
  struct Jacobian {
    V3d value;
    std::array<V3d, 3> columns;
  };
  Jacobian jacobian(double t, const V2d& at) const;

  /// Newton's method from `start` with the pseudo-inverse (S4 eq. 8-9), V fixed. Empty where it does not come to rest
  /// at a zero; the point may lie outside of the triangle. `tolerance`: of its last step.
  std::optional<V2d> solve(double t, const V2d& start, double tolerance = 1e-11) const;

  /// A point of the curve f = 0 on a side of the triangle.
  struct Crossing {
    double t;
    V2d at;
  };
  /// The sides as S4 names them: a = 0, b = 0, a + b = 1.
  enum class Side { kA, kB, kC };
  /// The same for t and the place along a side (S4 sect. 3.2.2).
  std::optional<Crossing> solve_on_side(Side side, const Crossing& start) const;

  /// The direction (t, a, b) of the curve at a zero: the kernel of the Jacobian (S4 sect. 3.2.3), not normalised.
  static V3d tangent(const Jacobian& jacobian);

 private:
  const Facet& facet_;
  LightPoint light_;
  Line line_;
  double eta_, sign_;
};

}  // namespace turbid
