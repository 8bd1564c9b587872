#pragma once
#include "path/passage.h"
#include "refraction/light_sample.h"
#include "refraction/refractive_interfaces.h"

namespace turbid {

/// How light that comes through a refractive interface is found along a flight of the sensor's path.
enum class RefractiveMethod {
  kTriangleIntervals,  ///< triangle by triangle, only where its light meets the flight (S4)
  kPointSampling,      ///< at points of the flight (Walter et al. 2009)
  kStraightLine,       ///< as if the interface did not bend light, at points of the flight: wrong, cheap and common
  kNone,               ///< not at all: shows what the others add
};

struct RefractiveSettings {
  RefractiveMethod method = RefractiveMethod::kTriangleIntervals;
  int samples = 1;            ///< per interval of a triangle, or per flight
  bool in_middle = false;     ///< of the strata (S4 eq. 18), not anywhere in them
  bool environments = false;  ///< their light is followed, too; else paths find it, which meet the sky easily
  bool focusing = true;       ///< false: D is taken for the square of the distance (S4 Fig. 11)
  /// Newton's steps to P, in the triangle's own coordinates, that are taken for rest (epsilon of S4 Fig. 12).
  double tolerance = 1e-10;
  int starts = 1;  ///< of Newton's method along each side of a triangle, for points; 1 is the seed's: its middle
};

/// Single scattering of light that one smooth interface bends on its way into a medium (S4, NUMERICS 4): paths light -
/// P - V - rest, with P on a RefractiveInterface and V anywhere on a flight through a medium.
///
/// For triangle intervals the integral over the flight is taken along the contour of each triangle (ContourPiece). With
/// coordinates (sigma, tau) along and across it, and h = meeting():
///   int dt eta^2 I / D = int dsigma I cos_L cos_gV / (cos_V d_L^2) area2 / |dh / dtau|,
/// cosines of the shading normal but cos_gV (of the geometric one); for equal normals that is the flux through
/// dsigma dtau over the area across which it passes the flight.
class RefractiveScattering {
 public:
  RefractiveScattering(const Scene& scene, const RefractiveSettings& settings);

  /// Recognises on a path from the sensor what gather() counts.
  CountedPath counted_path() const { return {interfaces_, settings_.environments}; }

  /// An estimate of the radiance that a single collision on the flight scatters to its origin. `flight`: through
  /// `medium`, up to the next surface. `throughput` as for pass_straight. Random numbers come from Sampler::aside.
  Spectrum gather(const Ray& flight, const Medium& medium, const Spectrum& throughput, const Sampler& sampler,
                  SampleCounters& counters) const;

 private:
  class Gathering;

  const Scene& scene_;
  RefractiveSettings settings_;
  RefractiveInterfaces interfaces_;
  /// Whose light is followed, with the probability of each; few lights are all asked.
  struct Light {
    const Emitter* emitter;
    float prob;
  };
  std::vector<Light> lights_;
  DiscreteDistribution choice_;  ///< among lights_, where they are many
};

}  // namespace turbid
