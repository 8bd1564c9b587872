#pragma once
#include "integrator/mcrt.h"

namespace turbid {

/// How noise and work of an image depend on q, the share of real collisions. The variance is linear in q: given the
/// light, a string of spheres is a compound Poisson process cut off at the real collision, whose second moment is
/// q A + (1 - q) B (docs/integration-spheres.md). Work is linear in 1/q, the number of spheres.
struct QTradeOff {
  double variance = 0, variance_by_q = 0;  ///< V(q) = variance + variance_by_q q
  double work = 0, work_by_spheres = 0;    ///< W(q) = work + work_by_spheres / q: in casts

  double product(double q) const { return (variance + variance_by_q * q) * (work + work_by_spheres / q); }
  /// The q in [least, 1] with the least product.
  double best(double least) const;
};
inline constexpr double kLeastQ = 1.0 / 256;

/// What images at one q were like.
struct QObservation {
  double q;
  double variance;  ///< of a pixel's value in one image: mean over pixels and channels
  double work;      ///< of an image, see work_of
};
QTradeOff trade_off(const QObservation& high, const QObservation& low);

/// The mean over pixels and channels of the variance of their samples.
double mean_variance(const Film& film);

/// Nearest-hit casts that the work of these counts is worth: counted, not timed, so that it depends on scene, settings
/// and seed alone.
double work_of(const Counters& counters);

/// Renders some images at two values of q, says what it found, and chooses.
float choose_q(const Scene& scene, const PathSettings& path, const McrtSettings& own, uint64_t seed,
               const StopFlag& stop);

}  // namespace turbid
