#pragma once

namespace turbid {

/// How a medium scatters: a density f(mu) in 1/sr over the sphere, 2 pi int f dmu = 1, where mu is the cosine of the
/// deflection, the angle between the directions of propagation before and after (mu = 1: straight on). Azimuth is
/// uniform. Immutable, shared between threads.
class PhaseFunction {
 public:
  virtual ~PhaseFunction() = default;
  /// f(mu), 1/sr; at the same time the density of sample().
  virtual float eval(float mu) const = 0;
  /// mu distributed as f in solid angle; takes one number u in [0,1).
  virtual float sample(float u) const = 0;
  /// Mean of mu.
  virtual float mean_cosine() const = 0;
};

}  // namespace turbid
