#pragma once
#include <cmath>
#include <memory>
#include <mutex>
#include <vector>

namespace turbid {

class AngleDistribution;

/// How a medium scatters: a density f(mu) in 1/sr over the sphere, 2 pi int f dmu = 1, where mu is the cosine of the
/// deflection, the angle between the directions of propagation before and after (mu = 1: straight on). Azimuth is
/// uniform. Immutable, shared between threads.
class PhaseFunction {
 public:
  virtual ~PhaseFunction() = default;
  /// f(mu), 1/sr; at the same time the density of sample(). Cosines that rounding has put beyond -1 or 1 count as
  /// those.
  virtual float eval(float mu) const = 0;
  /// mu distributed as f in solid angle; takes one number u in [0,1).
  virtual float sample(float u) const = 0;
  /// Mean of mu.
  virtual float mean_cosine() const = 0;

  /// f at a deflection of theta in [0, pi] radians, 1/sr: the function of eval(), with the digits that a cosine loses.
  /// Next to 1 a float mu has steps of 6e-8, which are 3e-4 rad; phase functions with narrow peaks go by
  /// 1 - mu = 2 sin^2(theta/2) instead.
  virtual float eval_angle(float theta) const { return eval(std::cos(theta)); }
  /// Angles in [0, pi], in any order, that whoever tabulates f must not step over: edges and narrow details. Peaks at
  /// the two ends need none.
  virtual std::vector<float> landmarks() const { return {}; }

  /// Sampling of the angle itself, for once-more scattered connections (NUMERICS 2.2). Made at the first call, which
  /// takes milliseconds, and kept; any thread may call.
  const AngleDistribution& angles() const;

 private:
  mutable std::once_flag angles_made_;
  mutable std::shared_ptr<const AngleDistribution> angles_;
};

}  // namespace turbid
