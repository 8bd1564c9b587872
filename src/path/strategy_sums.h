#pragma once
#include <cmath>
#include <limits>

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
///
/// A path may also be made by *merging*: both walks make a vertex, near to each other, and a kernel takes them for one
/// (Křivánek et al. 2014). The density is that of both walks times the measure of the kernel and the number of light
/// paths, `Merging`; the sums then run over merges, too (docs/photons.md).
struct StrategySums {
  double inverse_pdf = 0;  ///< 1 / density with which this side makes the vertex, per area or volume
  /// 1 if the strategy that joins this vertex with the one before it exists, else 0. At the first vertex after a light,
  /// the power of the density of next-event estimation over that of the walk's start.
  double joint = 0;
  /// Sum over the strategies with the line before the one before, and the merges at vertices before, over the density
  /// (1/sr) with which a walk from the other side would go on from this vertex to the one before.
  double behind = 0;
};

/// For each kind of merging, number of light paths times measure of the kernel; 0: it is not used. A density is what
/// both walks make the vertex with, by collisions, times this; where a walk need not collide but only pass, over the
/// density of collisions per length; two beams that cross meet with the sine of the angle between them.
struct Merging {
  double surface = 0;        ///< disks at surfaces, area
  double point_point = 0;    ///< balls around collisions (P-P3D), volume
  double point_beam = 0;     ///< collisions of light around flights from the sensor (P-B2D), area
  double beam_point = 0;     ///< flights of light around collisions (B-P2D), area
  double beam_beam = 0;      ///< flights around flights (B-B1D), length
  double inhomogeneous = 0;  ///< P-P3D where flights have no closed form, volume
  /// Media with a larger extinction (1/length) have smaller kernels, in proportion to their mean free path.
  double dense_from = std::numeric_limits<double>::infinity();

  bool in_media() const { return point_point + point_beam + beam_point + beam_beam + inhomogeneous > 0; }
};

/// The powers of the densities of all merges at one vertex, over the density with which both walks make it.
struct Merges {
  double point_point = 0, point_beam = 0, beam_point = 0, beam_beam = 0;
  double sum() const { return point_point + point_beam + beam_point + beam_beam; }
};

class StrategyWeights {
 public:
  enum class Heuristic { kBalance, kPower };

  /// `joins` false: no lines are tried, paths are made by merging; what has no vertex to merge at only by chance.
  explicit StrategyWeights(Heuristic heuristic, const Merging& merging = {}, bool joins = true)
      : squares_(heuristic == Heuristic::kPower),
        joins_(joins),
        merges_in_media_(merging.in_media()),
        surface_(power(merging.surface)),
        merging_(merging) {}

  bool joins() const { return joins_; }
  bool merges_in_media() const { return merges_in_media_; }
  const Merging& merging() const { return merging_; }

  /// A ratio of densities to the power of the heuristic.
  double power(double ratio) const { return squares_ ? ratio * ratio : ratio; }

  /// At a vertex on a surface with a smooth lobe.
  double merged_at_surface() const { return surface_; }
  /// At a collision. `sigma_t`: a stand-in for its extinction that is the same everywhere in the medium, 1/length; 0
  /// where flights have no closed form. `mu`: cosine of the deflection. `scale`: of the kernels' radii there.
  Merges merges_at(double sigma_t, float mu, double scale = 1) const {
    if (!merges_in_media_) return {};
    if (!(sigma_t > 0)) return {power(merging_.inhomogeneous), 0, 0, 0};
    const double inverse = 1 / sigma_t, sine = std::sqrt(std::max(0.0, 1 - double{mu} * double{mu}));
    const double area = scale * scale;
    return {power(merging_.point_point * area * scale), power(merging_.point_beam * area * inverse),
            power(merging_.beam_point * area * inverse), power(merging_.beam_beam * scale * sine * inverse * inverse)};
  }
  /// What multiplies the radii of kernels in a medium. `max_sigma_t`: the largest extinction of its channels, 1/length.
  double kernel_scale(double max_sigma_t) const {
    return max_sigma_t > merging_.dense_from ? merging_.dense_from / max_sigma_t : 1;
  }

  /// How a walk left a vertex.
  struct Departure {
    bool delta = true;      ///< in a direction without a density: nothing joins with this vertex, densities cancel
    double pdf_w = 1;       ///< of the direction, 1/sr; 1 where delta
    double pdf_back_w = 1;  ///< of the direction to the vertex before, for a walk that comes from the next, 1/sr
    double merged = 0;      ///< sum of the powers of the merges at this vertex
  };

  /// The sums at the next vertex. `arrive`: what turns a density per solid angle at the last vertex into one per area
  /// or volume at the next; `back`: the same for the opposite way.
  StrategySums next(const StrategySums& last, const Departure& by, double arrive, double back) const {
    const double joint = by.delta ? 0 : last.joint;
    return {1 / (by.pdf_w * arrive), by.delta || !joins_ ? 0.0 : 1.0,
            power(back) * by.merged + power(back * last.inverse_pdf) * (joint + power(by.pdf_back_w) * last.behind)};
  }

  /// Sum of (p_j / p)^b over the strategies whose line lies on this side of the vertex `at`, and the merges there and
  /// on this side. `pdf`: density with which the other side makes this vertex; `pdf_back_w`: with which it goes on to
  /// the one before; `merged`: sum of the powers of the merges at the vertex.
  double others(const StrategySums& at, double pdf, double pdf_back_w, double merged = 0) const {
    return power(pdf) * merged + power(pdf * at.inverse_pdf) * (at.joint + power(pdf_back_w) * at.behind);
  }

  /// What one side adds to the denominator of a merge's weight, see merge_weight.
  double beside_merge(const StrategySums& at, double pdf_back_w) const {
    return power(at.inverse_pdf) * (at.joint + power(pdf_back_w) * at.behind);
  }
  /// The weight of the merge whose power is `own`, of `merged` in all at the vertex; `beside`: the sum of beside_merge
  /// over both sides.
  static double merge_weight(double own, double merged, double beside) { return own / (merged + beside); }

 private:
  bool squares_, joins_, merges_in_media_;
  double surface_;
  Merging merging_;
};

}  // namespace turbid
