#pragma once
#include <array>
#include <optional>
#include <vector>

#include "scene/scene.h"
#include "table/multiple_scattering.h"

namespace turbid {

/// The plane that touches a medium's boundary somewhere.
struct BoundaryPlane {
  Vec3 point, normal;   ///< normal: unit, out of the medium
  float extrapolation;  ///< how far outside of it the fluence would fall to 0, 2 A D; a length
  float share = 1;      ///< the power to which its factor is raised: 0 counts nothing
};
using BoundaryPlanes = std::vector<BoundaryPlane>;
/// One more, which counts less the more it faces as those before it do: then they are about the same.
void add_boundary(const BoundaryPlane& plane, BoundaryPlanes& planes);

/// Where the boundaries of media are, and what they do to diffuse light.
///
/// Light that has scattered often obeys phi + 2 A D dphi/dn = 0 there (D = 1/(3 sigma_t (1 - g albedo)), A = (1 + r2) /
/// (1 - r1) by the moments of what the boundary reflects inside, 1 where nothing is). In a half-space the field of a
/// source is then that of the source, of its mirror image, and of a line of negative images behind that, of density
/// 2 exp(-s / 2AD) / 2AD at the distance s: nothing is lost where the boundary reflects all, and without reflection it
/// is nearly the one negative image of the extrapolated boundary. The whole field of the table is mirrored, not its
/// diffuse part alone.
class Boundaries {
 public:
  /// `media`: that planes are asked for. The scene must stay.
  Boundaries(const Scene& scene, const std::vector<const Medium*>& media);

  /// The boundaries around x: behind a walk that has come along `direction`, before it, and to four sides
  /// (add_boundary).
  BoundaryPlanes around(const Vec3& x, const Vec3& direction, const Medium& medium) const;
  /// Nothing stands between two places in a medium.
  bool lets_see(const Vec3& a, const Vec3& b) const {
    return !scene_.rays().occluded({a, normalize(b - a), length(b - a)});
  }
  /// The first one along a line through the medium.
  std::optional<BoundaryPlane> towards(const Ray& line, const Medium& medium) const;

 private:
  const Scene& scene_;
  std::vector<float> factors_;        ///< A of each object, seen from inside
  std::vector<float> outer_factors_;  ///< ... from outside
};

/// The light of a stretch, and its images by a plane.
std::array<WeightedStretch, 4> with_images(const Stretch& light, const BoundaryPlane& plane);

/// The source radiance of the stretch's light at x towards w (MultipleScattering), times a factor for each plane: what
/// its images leave of the light. One plane, and planes at right angles that reflect nothing, are so as images and
/// images of images have it (a Gaussian of space is a product); for others it is a guess that never falls below 0.
Spectrum bounded_source_radiance(const MultipleScattering& scattering, const Stretch& light,
                                 const BoundaryPlanes& planes, const Vec3& x, const Vec3& w);

}  // namespace turbid
