#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "path/path_settings.h"

namespace turbid {

/// How light is gathered along walks from the sensor (S5): in which volumes, by what, and which light where.
struct GatherSettings {
  enum class Volumes {
    kSpheres,   ///< at real and null collisions: q = 1 is one sphere per flight, q -> 0 a string of them
    kCylinders  ///< around whole flights
  };
  enum class Estimator {
    kTrack,     ///< light counts where it flies through a volume
    kCollision  ///< light counts where it collides in a volume
  };
  Volumes volumes = Volumes::kSpheres;
  Estimator estimator = Estimator::kTrack;
  float q = 1;  ///< share of the spheres that are real collisions, in (0, 1]

  /// Cylinders reach from where a flight begins to the next surface, with the transmittance as weight; else they end
  /// where the flight does.
  bool long_cylinders = true;
  /// Light counts along its way to the next surface, with the transmittance as weight; else until it collides.
  bool long_segments = false;

  /// Volumes stand at the walk's first so many collisions. All but the last take only light that has not been
  /// scattered (straight from a light or through mirrors and glass); the last takes what has been, too.
  int collisions = 1;
  /// Light that a rough surface has scattered into a medium is taken by the volumes there; else walks go on through
  /// the medium and take it at the surface (S5 sect. 2.2).
  bool surface_light_in_volumes = false;
  /// At surfaces light is gathered in disks; else walks go on from there and ask for light at every vertex.
  bool disks = true;
};

/// Radii of volumes: absolute, or in proportion to what a pixel covers at the distance.
struct GatherRadius {
  float at_sensor = 0;     ///< where walks begin, scene units
  float per_length = 0;    ///< growth with the distance walked
  float least_length = 0;  ///< nearer than this all radii are alike: none may vanish at a pinhole

  float at(float distance) const { return at_sensor + per_length * std::max(distance, least_length); }
  GatherRadius scaled(float factor) const { return {at_sensor * factor, per_length * factor, least_length}; }
};

/// Factor of the radius in image number `index` of a progressive render: the measure of the kernel, in `dimensions`
/// dimensions, falls so that the variance of one image grows like n^(1 - keep) (Knaus & Zwicker 2011, eq. 15 as a
/// closed form). keep = 1: no change. Depends on the number alone: any image can be made by itself.
inline float radius_factor(uint64_t index, float keep, int dimensions) {
  const double n = static_cast<double>(index) + 1, a = static_cast<double>(keep);
  const double measure = std::exp(std::lgamma(n + a) - std::lgamma(1 + a) - std::lgamma(n + 1));
  return static_cast<float>(std::pow(measure, 1.0 / dimensions));
}

}  // namespace turbid
