#pragma once
#include <optional>

#include "path/adjoint.h"
#include "path/events.h"
#include "path/strategy_sums.h"

namespace turbid {

/// A vertex of a walk that something can be joined with: a collision, or a point of a surface with a smooth lobe.
struct Vertex {
  Vec3 position;
  Vec3 given;           ///< unit, to where the walk comes from
  Spectrum throughput;  ///< PathState::throughput: all but the vertex's own scattering
  int depth = 0, order = 0, visit_order = 0;
  bool bent = false;               ///< walks from a light: CountedLight::is_bent
  const Medium* medium = nullptr;  ///< on the side of `given`; null: vacuum
  const Object* object = nullptr;  ///< null: a collision
  SurfacePoint point;              ///< of surfaces only
  Vec3 given_local;
  Spectrum events;  ///< collisions: extinction per length, or a stand-in (Medium::proxy_sigma_t); surfaces: 1
  StrategySums sums;

  Vertex(const CollisionEvent& event, const PathState& state)
      : position(event.position),
        given(-event.direction),
        throughput(state.throughput),
        depth(state.depth),
        order(state.order),
        visit_order(state.visit_order),
        medium(&event.medium),
        events(event.medium.proxy_sigma_t(event.position)) {}
  Vertex(const SurfaceEvent& event, const PathState& state, const Medium* around)
      : position(event.point.p),
        given(event.given),
        throughput(state.throughput),
        depth(state.depth),
        order(state.order),
        visit_order(state.visit_order),
        medium(around),
        object(&event.object),
        point(event.point),
        given_local(event.given_local),
        events(1.0f) {}

  bool is_surface() const { return object != nullptr; }
  /// Empty at collisions.
  std::optional<SurfaceEvent> surface_event() const {
    if (!is_surface()) return std::nullopt;
    return SurfaceEvent{*object, point, given, given_local};
  }
  /// Where rays in this direction start.
  Vec3 leave(const Vec3& direction) const { return is_surface() ? point.leave(direction) : position; }
  /// On the side that the direction leads to. Not for scenes with priorities.
  const Medium* medium_towards(const Vec3& direction) const {
    return is_surface() && object->bounds_media ? object->medium_towards(point.ng, direction) : medium;
  }

  /// Collisions so far in the visit to a medium that goes on towards `chosen` (PathState::visit_order).
  int visit_order_towards(const Vec3& chosen) const {
    if (!is_surface()) return visit_order;
    const bool reflects = dot(chosen, point.ng) * dot(given, point.ng) > 0;
    return reflects && keeps_visit(*object->bsdf) ? visit_order : 0;
  }

  struct Scattering {
    Spectrum value;        ///< phase function, or f |cos| with what `mode` asks for (shading normals included), 1/sr
    float pdf_w = 0;       ///< with which the walk would have chosen the direction, 1/sr
    float pdf_back_w = 0;  ///< with which a walk from the other side would choose `given`, 1/sr
  };
  /// Scattering into the direction `chosen` (unit, away from here) by the smooth lobes.
  Scattering scatter(const Vec3& chosen, TransportMode mode) const;
  /// Its value alone.
  Spectrum scattered(const Vec3& chosen, TransportMode mode) const {
    if (!is_surface()) return Spectrum(medium->phase().eval(-dot(given, chosen)));
    return surface_eval(point.to_local(chosen), chosen, mode).value;
  }

  /// |cos| of a direction at a surface, 1 at a collision.
  float cosine(const Vec3& direction) const { return is_surface() ? std::abs(dot(point.ng, direction)) : 1; }

 private:
  /// Bsdf::eval, corrected for shading normals in walks from a light; nothing where the normals disagree.
  Bsdf::Eval surface_eval(const Vec3& chosen_local, const Vec3& chosen, TransportMode mode) const {
    if (!(chosen_local.z * dot(chosen, point.ng) > 0)) return {};
    Bsdf::Eval there = object->bsdf->eval(point, given_local, chosen_local, mode);
    if (mode == TransportMode::kImportance && !there.value.is_black())
      there.value *= adjoint_correction(point, given, chosen);
    return there;
  }
};

/// What turns a density per solid angle into one per area or volume at the end of an edge, but for 1/distance^2: the
/// probability of coming through (the channels mixed evenly) with a collision per length, or with |cos|.
inline double end_factor(const Spectrum& events, float cosine, const Spectrum& proxy) {
  return static_cast<double>((events * proxy).mean() * cosine);
}

/// Of a walk that arrives along `direction` (either sign) after an edge that lets `proxy` through.
inline double end_factor(const Vertex& vertex, const Vec3& direction, const Spectrum& proxy) {
  return end_factor(vertex.events, vertex.cosine(direction), proxy);
}

inline Vertex::Scattering Vertex::scatter(const Vec3& chosen, TransportMode mode) const {
  if (!is_surface()) {
    const float f = medium->phase().eval(-dot(given, chosen));
    return {Spectrum(f), f, f};
  }
  const Vec3 chosen_local = point.to_local(chosen);
  const Bsdf::Eval there = surface_eval(chosen_local, chosen, mode);
  if (there.value.is_black()) return {};
  const TransportMode opposite =
      mode == TransportMode::kImportance ? TransportMode::kRadiance : TransportMode::kImportance;
  const Bsdf::Eval back = object->bsdf->eval(point, chosen_local, given_local, opposite);
  return {there.value, there.pdf_w, back.pdf_w};
}

}  // namespace turbid
