#pragma once
#include <optional>

#include "path/once_more.h"
#include "path/passage.h"
#include "path/vertex.h"
#include "scene/scene.h"

namespace turbid {

/// How the collision x1 between a vertex x0 of a walk and the other end x2 of its path (a point of a light, of the
/// sensor's aperture; a direction where light comes from infinity) is found.
enum class ConnectionTechnique {
  kStandard,     ///< by the walk: the direction by scattering at x0, the distance by a free flight
  kEquiangular,  ///< the direction by scattering, the distance in proportion to 1/d2^2 (Kulla & Fajardo 2012)
  kProduct,      ///< the direction by scattering, the distance in proportion to f/d2^2, tabulated
  kOnceMore,  ///< inserted between x0 and x2 (S3); where the direction is given, as kProduct, which is its conditional
  kMis,       ///< the walk, kProduct and kOnceMore, weighted by the power heuristic
};

struct ConnectionSettings {
  ConnectionTechnique technique = ConnectionTechnique::kStandard;
  Insertion insertion = Insertion::kAngle;  ///< of collisions that are inserted
};

/// How x0 is left: what all techniques that make x1 must know.
struct Departure {
  Vec3 position;                   ///< x0
  const Medium* medium = nullptr;  ///< whose phase function is expected at x1; null: the walk alone makes x1
  bool open = false;               ///< the direction was chosen among many; else given: a pixel's ray, a beam, a mirror
  float pdf_w = 1;                 ///< of the direction, 1/sr; 1 where it is given
};

/// Light comes along the passage to x1, where the medium is the one that was expected.
inline bool scatters_as_expected(const Departure& from, const Passage& passage) {
  return passage.prob > 0 && passage.medium && &passage.medium->phase() == &from.medium->phase();
}

/// The way from x0 to x1.
struct Edge {
  Departure from;
  Vec3 direction;
  float length = 0;  ///< d1
  Spectrum sigma;    ///< Medium::proxy_sigma_t at x1
  Spectrum proxy;    ///< Passage::proxy
};

/// The densities of x1 by the techniques, per volume, or where the direction is given per volume times 1/sr; 0 where
/// one does not apply.
struct CollisionDensities {
  double walk = 0;      ///< times the density of a free flight (a stand-in that depends on the edge alone)
  double along = 0;     ///< of kEquiangular or kProduct
  double inserted = 0;  ///< of kOnceMore
};

/// Makes collisions between a vertex and the other end of its path, and tells with which density any technique would
/// have made a given one: so paths from either end share them (NUMERICS 2). The density of a place along the ray with
/// direction w from x0 is p_w / d1^2 times that of the distance; both kinds of rays towards x2 have the angle between
/// the ray and the way from x1 to x2 as their coordinate.
class ConnectionSampler {
 public:
  ConnectionSampler(const Scene& scene, const ConnectionSettings& settings);

  /// False: the walk makes all collisions.
  bool active() const { return technique_ != ConnectionTechnique::kStandard; }
  /// The medium that collisions next to a vertex are expected in, which `around` fills the space at (null: vacuum; then
  /// the thinnest of the scene). Null where the walk alone makes them.
  const Medium* expected(const Medium* around) const;
  /// The same next to a surface, which `around` fills the space in front of: that of one of its sides.
  const Medium* expected(const Object& object, const Medium* around) const;

  /// Whether collisions are inserted from x0, and whether they are made along the ray that leaves it.
  bool inserts(const Departure& from) const {
    return from.medium && from.open &&
           (technique_ == ConnectionTechnique::kOnceMore || technique_ == ConnectionTechnique::kMis);
  }
  bool marches(const Departure& from) const {
    return from.medium && !(from.open && technique_ == ConnectionTechnique::kOnceMore);
  }

  /// Inserts a collision between x0 and the end, see insert_collision and insert_collision_towards; only where
  /// inserts(). Takes three numbers.
  std::optional<InsertedCollision> insert(const Departure& from, const PathEnd& end, float u_theta, float u_beta,
                                          float u_phi) const;

  struct Distance {
    float t = 0;       ///< from x0
    double pdf_t = 0;  ///< 1/length
  };
  /// A distance along the ray that leaves x0 in `direction` (unit); only where marches(). Takes one number. Empty where
  /// the end lies at infinity, and where no place of the ray is in its cone.
  std::optional<Distance> march(const Departure& from, const Vec3& direction, const PathEnd& end, float u) const;

  /// With which densities x1, the end of the edge, would have been made. `inserted`: where that one is known.
  CollisionDensities densities(const Edge& edge, const PathEnd& end,
                               std::optional<double> inserted = std::nullopt) const;

  /// False: a path is made by one technique alone, and nobody need ask for densities to weigh an x1 that was made.
  bool weighs() const { return technique_ == ConnectionTechnique::kMis; }
  /// The weight of the technique whose density among `all` is `own`: power heuristic.
  static double weight(double own, const CollisionDensities& all);
  /// That of the walk. `advantage`: what else it does better than the others, as a factor of its density.
  double walk_weight(const Edge& edge, const PathEnd& end, double advantage = 1) const;

 private:
  /// Whether another technique than the walk makes x1 at all.
  bool makes(const Edge& edge, const PathEnd& end) const;
  double pdf_t(const Departure& from, const Vec3& direction, float t, const PathEnd& end) const;

  const Scene& scene_;
  ConnectionTechnique technique_;  ///< kStandard in scenes with priorities
  Insertion insertion_;
};

}  // namespace turbid
