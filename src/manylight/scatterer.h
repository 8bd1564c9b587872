#pragma once
#include "path/path_settings.h"
#include "path/vertex.h"

namespace turbid {

/// One end of a line that brings light: a vertex with what the walk carries to it, made quick to ask for many
/// directions. For walks from a light (kImportance) it is a virtual point light, for walks from the sensor (kRadiance)
/// a place that is shaded.
class Scatterer {
 public:
  /// The vertex must stay where it is.
  Scatterer(const Vertex& vertex, TransportMode mode);
  /// A collision that was made, of a walk from either end.
  Scatterer(const CollisionEvent& event, const PathState& state)
      : position_(event.position),
        normal_(0),
        other_normal_(0),
        given_(-event.direction),
        scale_(state.throughput),
        medium_(&event.medium),
        phase_(&event.medium.phase()),
        vertex_(nullptr),
        depth_(state.depth),
        order_(state.order),
        visit_order_(state.visit_order),
        kind_(Kind::kCollision),
        mode_(TransportMode::kRadiance) {}

  const Vec3& position() const { return position_; }
  /// Only of surfaces, and of collisions made from one.
  const Vertex& vertex() const { return *vertex_; }
  /// Where lines in this direction start.
  Vec3 leave(const Vec3& direction) const { return is_surface() ? vertex_->point.leave(direction) : position_; }
  int depth() const { return depth_; }
  int order() const { return order_; }
  /// Vertex::visit_order_towards.
  int visit_order_towards(const Vec3& chosen) const {
    return is_surface() ? vertex_->visit_order_towards(chosen) : visit_order_;
  }
  /// Of collisions: the medium they are in; else null.
  const Medium* medium() const { return medium_; }
  bool is_surface() const { return kind_ != Kind::kCollision; }
  /// Surfaces: the normal by which cosines go, on the side that scatters diffusely.
  const Vec3& normal() const { return normal_; }
  /// Scatters diffusely to the side of normal(), and to no other.
  bool is_diffuse() const { return kind_ == Kind::kDiffuse; }

  /// Throughput times scattering into `direction` (unit, away from here): of a light W/sr, of a shaded place 1/sr times
  /// what the sensor makes of radiance; surfaces with |cos|.
  Spectrum towards(const Vec3& direction) const {
    switch (kind_) {
      case Kind::kCollision:
        return scale_ * phase_->eval(-dot(given_, direction));
      case Kind::kDiffuse: {
        const float cosine = dot(direction, normal_);
        return cosine > 0 && dot(direction, other_normal_) > 0 ? scale_ * cosine : Spectrum(0.0f);
      }
      default:
        return scale_ * vertex_->scattered(direction, mode_);
    }
  }

  /// The largest channel of towards() in any direction, about; for choosing among lights.
  float strength() const;

 private:
  enum class Kind : uint8_t { kCollision, kDiffuse, kAny };

  Vec3 position_, normal_, other_normal_, given_;
  Spectrum scale_;
  const Medium* medium_ = nullptr;
  const PhaseFunction* phase_ = nullptr;
  const Vertex* vertex_;
  int depth_, order_, visit_order_;
  Kind kind_ = Kind::kAny;
  TransportMode mode_;
};

/// The lines between lights and shaded places.
struct LineSettings {
  /// Light over less than this distance is left out: for comparing pictures without the term 1/distance^2 that has no
  /// variance. 0: all light.
  float least_distance = 0;
  /// Distances count as at least this long in 1/distance^2 (biased); 0: as they are.
  float clamp_distance = 0;
  int max_depth = PathSettings::kUnlimited;
};

/// What the light would bring to the place if nothing stood between: L f G of S2 eq. 3 without V and transmittance, but
/// with anisotropic and glossy lobes on both ends.
inline Spectrum unshadowed(const Scatterer& place, const Scatterer& light, const LineSettings& settings) {
  if (place.depth() + 1 > settings.max_depth - light.depth()) return Spectrum(0.0f);
  const Vec3 way = light.position() - place.position();
  const float distance2 = dot(way, way);
  if (!(distance2 > 0) || distance2 < sqr(settings.least_distance)) return Spectrum(0.0f);
  const Vec3 wi = way / std::sqrt(distance2);
  const Spectrum there = light.towards(-wi);
  if (there.is_black()) return Spectrum(0.0f);
  return place.towards(wi) * there / std::max(distance2, sqr(settings.clamp_distance));
}

}  // namespace turbid
