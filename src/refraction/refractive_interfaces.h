#pragma once
#include <map>

#include "path/events.h"
#include "refraction/position_normal_tree.h"
#include "surface/dielectric.h"

namespace turbid {

/// A smooth boundary that light is followed through: a triangle mesh of a smooth dielectric that does not shine.
struct RefractiveInterface {
  RefractiveInterface(const Object& boundary, const TriangleMesh& triangles, const Dielectric& dielectric)
      : object(&boundary), mesh(&triangles), bsdf(&dielectric), tree(triangles) {}

  const Object* object;
  const TriangleMesh* mesh;
  const Dielectric* bsdf;
  PositionNormalTree tree;

  /// Space of this medium (null: vacuum) may lie on the inside (or the outside) of the surface.
  bool may_have(const Medium* medium, bool inside) const {
    return !object->bounds_media || (inside ? object->interior : object->exterior).get() == medium;
  }
  /// Index where the collision is over index at the light, for light that stands on the inside or not.
  double eta(bool light_inside) const {
    const auto interior_over_exterior = static_cast<double>(bsdf->eta());
    return light_inside ? 1 / interior_over_exterior : interior_over_exterior;
  }
};

/// All interfaces of a scene. Every other boundary (rough, of spheres, cylinders and instances, in scenes with
/// priorities) is left to path sampling.
class RefractiveInterfaces {
 public:
  explicit RefractiveInterfaces(const Scene& scene);

  const std::vector<RefractiveInterface>& all() const { return all_; }
  /// Null where the object is none.
  const RefractiveInterface* find(const Object& object) const;

 private:
  std::vector<RefractiveInterface> all_;
  std::map<const Object*, size_t> index_;
};

/// Does refraction at this point of a surface count?
inline bool bends_light(const RefractiveInterfaces& interfaces, const SurfaceEvent& event, const BsdfSample& sample) {
  if (!(sample.flags & lobe::kTransmission)) return false;
  const RefractiveInterface* found = interfaces.find(event.object);
  return found && shades_with_blend(facet_of(*found->mesh, event.point.primitive), V2d(event.point.barycentric));
}

/// Recognises, while a walk from the sensor goes on, the paths that RefractiveScattering counts: the first collision V,
/// then refraction at an interface, then a light; null surfaces anywhere. Whoever adds its light leaves these out.
class CountedPath {
 public:
  /// `environments`: their light counts, too.
  CountedPath(const RefractiveInterfaces& interfaces, bool environments)
      : interfaces_(interfaces), environments_(environments) {}

  void collided(const Medium& medium, int order) {
    at_collision_ = order == 1;
    refracted_ = false;
    medium_ = &medium;
  }
  /// `around`: the medium on the side that the walk came from.
  void left_surface(const SurfaceEvent& event, const BsdfSample& sample, const Medium* around) {
    refracted_ = at_collision_ && around == medium_ && bends_light(interfaces_, event, sample);
    at_collision_ = false;
  }
  /// The light that is met now, on a surface or at infinity, is counted elsewhere.
  bool is_counted(bool environment) const { return refracted_ && (environments_ || !environment); }

 private:
  const RefractiveInterfaces& interfaces_;
  const bool environments_;
  bool at_collision_ = false, refracted_ = false;
  const Medium* medium_ = nullptr;
};

/// The same for walks from a light: the light, refraction at an interface, then the first collision V. What follows
/// belongs to a counted path if it does not collide again.
class CountedLight {
 public:
  /// `interfaces` null: nothing is counted elsewhere.
  CountedLight(const RefractiveInterfaces* interfaces, bool environments)
      : interfaces_(interfaces), environments_(environments) {}

  void left(const Emitter& emitter) {
    const bool followed = interfaces_ && emitter.can_be_aimed_at() && (environments_ || !emitter.is_environment());
    state_ = followed ? State::kStarted : State::kOther;
  }
  /// `beyond`: the medium on the side that the walk goes to.
  void left_surface(const SurfaceEvent& event, const BsdfSample& sample, const Medium* beyond) {
    if (state_ == State::kBent) return;
    const bool refracts = state_ == State::kStarted && bends_light(*interfaces_, event, sample);
    state_ = refracts ? State::kRefracted : State::kOther;
    medium_ = beyond;
  }
  void collided(const Medium& medium) {
    if (state_ != State::kBent) state_ = may_collide(medium) ? State::kBent : State::kOther;
  }
  /// The walk has come over P and V.
  bool is_bent() const { return state_ == State::kBent; }
  /// The walk has come over P, and a collision in the medium would be V.
  bool may_collide(const Medium& medium) const { return state_ == State::kRefracted && medium_ == &medium; }

 private:
  enum class State { kOther, kStarted, kRefracted, kBent };
  const RefractiveInterfaces* interfaces_;
  bool environments_;
  State state_ = State::kOther;
  const Medium* medium_ = nullptr;
};

/// Is a path of so many collisions counted elsewhere, where its walk from the light says `bent`?
inline bool counted_elsewhere(bool bent, int order) { return bent && order == 1; }

}  // namespace turbid
