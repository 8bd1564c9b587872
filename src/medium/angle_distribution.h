#pragma once
#include <numbers>
#include <vector>

#include "medium/node_index.h"

namespace turbid {

class PhaseFunction;

/// The angles of a triangle whose corner x1 scatters: the deflection theta there, and gamma at one of the other two
/// corners. The pairs 0 < gamma < theta < pi with density f(cos theta) / Z, Z = int_0^pi theta f dtheta, make the
/// weight of a once-more scattered connection constant (NUMERICS 2.2); theta alone is then distributed as theta f / Z.
/// The same holds where gamma is confined to a range, because only x1 within a cone counts, with a smaller Z; and theta
/// given gamma is what a ray with that angle to the other corner asks for.
///
/// A table of f, quadratic between nodes that lie as closely as f asks for, so that f is met within about 1e-5 of its
/// value nearly everywhere; its integrals are exact and inverted to rounding: pdf() and pdf_beyond() are the densities
/// of the samples, whatever f is. Angles in radians. Immutable, shared between threads.
class AngleDistribution {
 public:
  /// Evaluates f at hundreds to thousands of angles. Throws std::invalid_argument when f is negative or not finite
  /// somewhere.
  explicit AngleDistribution(const PhaseFunction& phase);

  /// A range of gamma, 0 <= from <= to <= pi, and its Z.
  struct Range {
    double from, to;
    double first, last;  ///< int_from^pi int_gamma^pi f dtheta dgamma; the same from `to`
    double moment() const { return first - last; }
  };
  Range range(double from = 0, double to = std::numbers::pi) const { return {from, to, integral(from), integral(to)}; }

  /// gamma in a range, by one number in [0,1). Density int_gamma^pi f / Z.
  double sample(const Range& range, double u) const;
  /// theta beyond gamma, up to `to`, by one number in [0,1); gamma itself where f is 0 everywhere there.
  double sample_beyond(double gamma, double u, double to = std::numbers::pi) const;

  /// Density of a pair: of gamma from sample(range), theta from sample_beyond(gamma). 1/rad^2.
  double pdf(const Range& range, double theta) const { return f(theta) / range.moment(); }
  /// Density of sample_beyond(gamma, u, to), 1/rad.
  double pdf_beyond(double gamma, double theta, double to = std::numbers::pi) const;

  /// Z of all angles, rad/sr. 2 pi Z is pi^2/4 for the isotropic phase function and 1 for one that only goes straight
  /// on.
  double moment() const { return range().moment(); }
  /// Size of the table.
  size_t nodes() const { return table_.size() + 1; }

 private:
  /// Between two nodes, as functions of the distance w before the upper one.
  struct Interval {
    double end, width;
    double f, slope, bend;  ///< f + slope w + bend w^2
    double tail = 0;        ///< int_end^pi f
    double integral = 0;    ///< int_end^pi of the tail
    double f_at(double w) const { return f + w * (slope + w * bend); }
    double tail_at(double w) const { return tail + w * (f + w * (slope / 2 + w * bend / 3)); }
    double integral_at(double w) const { return integral + w * (tail + w * (f / 2 + w * (slope / 6 + w * bend / 12))); }
  };
  const Interval& interval(double theta) const { return table_[by_theta_.interval(static_cast<float>(theta))]; }

  double f(double theta) const;
  double tail(double theta) const;
  double integral(double theta) const;

  std::vector<Interval> table_;
  NodeIndex by_theta_;
  NodeIndex by_tail_, by_integral_;  ///< of the intervals from the last to the first: what each has at its end
};

}  // namespace turbid
