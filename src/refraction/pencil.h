#pragma once
#include "refraction/facet.h"

namespace turbid {

/// A point that shines, or a direction to a light at infinity.
struct LightPoint {
  V3d place;                 ///< position, or the unit direction to the light
  bool at_infinity = false;  ///< `place` is a direction
};

/// A straight line, at `origin` for t = 0; the direction is a unit vector.
struct Line {
  V3d origin, direction;
  V3d at(double t) const { return origin + direction * t; }
};

/// The light of one point that a facet refracts: one ray through each of its points, bent at the shading normal. The
/// light stands on the side that the facet's normals point to.
///
/// With eta = index where the refracted ray goes / index at the light, and unit vectors w_L (P to the light), N:
///   w = -w_L / eta + (cos_L / eta - cos_T) N,   cos_L = w_L . N,   cos_T^2 = 1 - (1 - cos_L^2) / eta^2.
/// Both this and its derivatives go on smoothly where the light sinks below the horizon of N; beyond the critical angle
/// cos_T stays 0. Such rays carry no light (`valid`).
class Pencil {
 public:
  Pencil(const Facet& facet, const LightPoint& light, double eta)
      : facet_(facet), light_(light), inverse_eta_(1 / eta) {}

  struct Ray {
    V3d p;             ///< on the facet
    V3d normal;        ///< shading normal, unit, on the light's side
    V3d to_light;      ///< unit
    V3d direction;     ///< away from the facet, unit where cos_refracted > 0
    double distance;   ///< to the light; 1 for lights at infinity
    double cos_light;  ///< w_L . N
    double cos_refracted;
  };
  Ray ray(const V2d& at) const;

  /// The ray with the change of its point and direction with a and b.
  struct Differential {
    Ray ray;
    V3d p_a, p_b, direction_a, direction_b;
  };
  Differential differential(const V2d& at) const;

  /// Both normals agree that the light is on the one side of the facet and the refracted ray on the other.
  bool valid(const Ray& ray) const {
    return ray.cos_light > 0 && ray.cos_refracted > 0 && ray.to_light.dot(facet_.ng) > 0 &&
           ray.direction.dot(facet_.ng) < 0;
  }

  const Facet& facet() const { return facet_; }
  double eta() const { return 1 / inverse_eta_; }

 private:
  const Facet& facet_;
  LightPoint light_;
  double inverse_eta_;
};

/// Six times the volume that two lines span with their directions: (w x d) . (P - O). It is 0 where the refracted ray
/// meets the line (or the line that the ray lies on does, or both are parallel).
inline double meeting(const Pencil::Ray& ray, const Line& line) {
  return ray.direction.cross(line.direction).dot(ray.p - line.origin);
}
/// Its derivatives by a and b.
V2d meeting_gradient(const Pencil::Differential& there, const Line& line);

/// Where a ray comes next to a line: along the line (t) and along the ray. Not finite for parallels.
struct Encounter {
  double on_line, on_ray;
};
Encounter encounter(const Pencil::Ray& ray, const Line& line);

}  // namespace turbid
