#pragma once

namespace turbid {

/// A path of k edges can be made in many ways: s of its vertices by a walk from a light, the others by a walk from the
/// sensor, the two joined by a line. Multiple importance sampling weighs strategy s by p_s^b / sum_j p_j^b (Veach 1997,
/// sect. 10.2): b = 1 is the balance heuristic, b = 2 the power heuristic.
///
/// p_s is the product of the densities with which the vertices are made, so that p_j / p_s for j < s is the product of
/// "made from the sensor / made from the light" over the vertices in between. Each subpath keeps the sum of these
/// ratios at its vertices, as far as they are known there: a connection then costs constant time, however long the
/// path (the recursion of Georgiev et al. 2012, for any densities and both heuristics). The sums are the same for both
/// ends; "this side" is the end that the subpath begins at.
struct StrategySums {
  double inverse_pdf = 0;  ///< 1 / density with which this side makes the vertex, per area or volume
  /// 1 if the strategy that joins this vertex with the one before it exists, else 0. At the first vertex after a light,
  /// the power of the density of next-event estimation over that of the walk's start.
  double joint = 0;
  /// Sum over the strategies with the line before the one before, over the density (1/sr) with which a walk from the
  /// other side would go on from this vertex to the one before.
  double behind = 0;
};

class StrategyWeights {
 public:
  enum class Heuristic { kBalance, kPower };

  explicit StrategyWeights(Heuristic heuristic) : squares_(heuristic == Heuristic::kPower) {}

  /// A ratio of densities to the power of the heuristic.
  double power(double ratio) const { return squares_ ? ratio * ratio : ratio; }

  /// How a walk left a vertex.
  struct Departure {
    bool delta = true;      ///< in a direction without a density: nothing joins with this vertex, densities cancel
    double pdf_w = 1;       ///< of the direction, 1/sr; 1 where delta
    double pdf_back_w = 1;  ///< of the direction to the vertex before, for a walk that comes from the next, 1/sr
  };

  /// The sums at the next vertex. `arrive`: what turns a density per solid angle at the last vertex into one per area
  /// or volume at the next; `back`: the same for the opposite way.
  StrategySums next(const StrategySums& last, const Departure& by, double arrive, double back) const {
    const double joint = by.delta ? 0 : last.joint;
    return {1 / (by.pdf_w * arrive), by.delta ? 0.0 : 1.0,
            power(back * last.inverse_pdf) * (joint + power(by.pdf_back_w) * last.behind)};
  }

  /// Sum of (p_j / p)^b over the strategies whose line lies on this side of the vertex `at`. `pdf`: density with which
  /// the other side makes this vertex; `pdf_back_w`: with which it goes on to the one before.
  double others(const StrategySums& at, double pdf, double pdf_back_w) const {
    return power(pdf * at.inverse_pdf) * (at.joint + power(pdf_back_w) * at.behind);
  }

 private:
  bool squares_;
};

}  // namespace turbid
