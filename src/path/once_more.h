#pragma once
#include <optional>

#include "core/cone.h"
#include "core/spectrum.h"
#include "core/vector.h"
#include "medium/phase_function.h"

namespace turbid {

/// Once-more scattered connections (S3): between two ends x0 and x2 a collision x1 is inserted, so that the light of x0
/// reaches x2 after one more scattering. With s = |x2 - x0|, d1 = |x1 - x0|, d2 = |x2 - x1|, the deflection theta at
/// x1, the angle beta at x0 between the ways to x2 and to x1 (0 < beta < theta) and the azimuth phi about the line x0
/// x2,
///   dx1 = (d1^2 d2^2 / s) dtheta dbeta dphi  for all theta in (0, pi)   (NUMERICS 2.1).
/// Both inverse squares cancel, for forward and for backward scattering; x1 may lie beyond either end.
enum class Insertion {
  /// Density f / Z in theta and gamma = theta - beta, so theta with density theta f / Z: f / (d1^2 d2^2) over the
  /// density
  /// of x1 is the constant 2 pi Z / s, on the whole sphere (NUMERICS 2.2). Where x2 gives or takes light in a cone
  /// only,
  /// gamma and the azimuth are confined to it, and Z shrinks.
  kAngle,
  /// theta by the phase function in solid angle, beta uniform in (0, theta), as published (S3 eq. 41-43). Only the
  /// forward hemisphere, theta < pi/2: the weight theta / (s sin theta) has no variance near pi. Half of the sphere is
  /// never sampled: exact for phase functions that only scatter forward, one of several techniques for others.
  kSolidAngle,
  /// Both geometry terms alone, as if the medium scattered isotropically: theta with density 2 theta / pi^2. This is
  /// joint importance sampling (Georgiev et al. 2013) where one collision stands between two points.
  kGeometry,
};

/// What a path ends with: a point, or a direction (unit, towards it) where the light comes from infinity.
struct PathEnd {
  Vec3 place;
  bool at_infinity = false;
  Cone cone{};  ///< of the directions from a point in which it gives or takes light

  /// Unit, from a place before it.
  Vec3 direction_from(const Vec3& p) const { return at_infinity ? place : normalize(place - p); }
};

/// Where x1 lies as seen from both ends.
struct InsertedCollision {
  Vec3 position;
  Vec3 arrives;  ///< unit, the direction of light from x0 to x1
  Vec3 leaves;   ///< unit, the direction from x1 to x2
  float d1 = 0, d2 = 0;
  float theta = 0;   ///< between the two directions, radians
  float f = 0;       ///< phase function at x1, 1/sr
  double pdf_v = 0;  ///< 1/volume
};

/// Draws x1 between a point and the end of a path that is a point too; takes three numbers. Empty where the ends
/// coincide, where the drawn triangle is too flat or too large for single precision, and for kSolidAngle where the
/// light would turn back.
std::optional<InsertedCollision> insert_collision(const PhaseFunction& phase, const Vec3& x0, const PathEnd& x2,
                                                  Insertion insertion, float u_theta, float u_beta, float u_phi);

/// Density with which insert_collision draws a given x1, 1/volume; 0 where it never does.
double insertion_pdf_v(const PhaseFunction& phase, const Vec3& x0, const Vec3& x1, const PathEnd& x2,
                       Insertion insertion);

/// Where the other end is a direction, the deflection theta is the angle at x0 and only the direction to x1 is special:
/// it is drawn by the phase function (kGeometry: uniformly), the distance d1 with density mean(sigma_t exp(-sigma_t
/// d1)) over the channels. Takes three numbers; d2 is infinite.
std::optional<InsertedCollision> insert_collision_towards(const PhaseFunction& phase, const Spectrum& sigma_t,
                                                          const Vec3& x0, const Vec3& direction, Insertion insertion,
                                                          float u_theta, float u_phi, float u_distance);
double insertion_pdf_v_towards(const PhaseFunction& phase, const Spectrum& sigma_t, const Vec3& x0, const Vec3& x1,
                               const Vec3& direction, Insertion insertion);

}  // namespace turbid
