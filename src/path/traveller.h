#pragma once
#include "medium/homogeneous.h"
#include "path/events.h"
#include "path/passage.h"

namespace turbid {

/// The part of a walk that flies: where it is, where it goes, and what fills the space there. Walks from the sensor and
/// from lights share it; what happens at collisions and surfaces, and what the walk carries, is theirs.
class Traveller {
 public:
  /// `sees_media` false: media are ignored altogether.
  Traveller(const Scene& scene, bool sees_media, Sampler& sampler, SampleCounters& counters)
      : scene_(scene),
        sampler_(sampler),
        counters_(counters),
        sees_media_(sees_media),
        stacked_(sees_media && scene.has_priorities()) {}

  /// Begins in `medium`, or in scenes with priorities inside of the shapes `enclosing`.
  void start(const Ray& ray, const Medium* medium, const MediumStack& enclosing) {
    ray_ = ray;
    free_radius2_ = 0;
    if (stacked_) media_ = enclosing;
    if (sees_media_) enter(stacked_ ? media_.medium() : medium);
  }

  /// From where the last event was, on towards the next.
  const Ray& ray() const { return ray_; }
  /// What fills the space here; null: vacuum, or media are ignored.
  const Medium* medium() const { return medium_; }
  /// On the side of the surface where the traveller stands that the direction leads to. Not for scenes with priorities.
  const Medium* medium_towards(const SurfaceEvent& event, const Vec3& direction) const {
    return event.object.bounds_media ? event.object.medium_towards(event.point.ng, direction) : medium_;
  }
  /// No straight line from here reaches a light (Surroundings::blind). Only inside a medium.
  bool blind() const { return surroundings_->blind; }
  /// The surface does not exist here (MediumStack::hides).
  bool hides(const Object& object) const { return stacked_ && media_.hides(object); }

  /// A flight through a medium.
  struct Leg {
    bool collides;  ///< at ray().origin; else it came to `hit` (empty: out of the scene)
    Hit hit;
    float length = 0;   ///< distance flown, at most to the end of the world
    Spectrum weight;    ///< Flight::weight
    Spectrum proxy;     ///< passed: Medium::proxy_transmittance of the way
    Spectrum emission;  ///< Flight::emission
  };
  /// Flies through the medium. `throughput`: that of the walk, sets the mixture of channels.
  Leg fly(const Spectrum& throughput);

  /// Goes straight through the medium to the next surface, or out of the scene: the leg's weight is the transmittance
  /// of the way. Leaves out what glows.
  Leg pass() {
    ++counters_.rays;
    const Hit hit = scene_.rays().intersect(ray_);
    const Ray way{ray_.origin, ray_.direction, hit ? hit.t : end_of_ray()};
    return {false,         hit, way.t_max, medium_->transmittance(way, sampler_), medium_->proxy_transmittance(way),
            Spectrum(0.0f)};
  }

  /// The next surface through empty space.
  Hit cast() {
    ++counters_.rays;
    return scene_.rays().intersect(ray_);
  }

  /// Goes on from a collision in another direction.
  void turn(const Vec3& direction) { ray_ = {ray_.origin, direction}; }

  /// Goes on from a surface in any direction, on either side.
  void leave(const Object& object, const SurfacePoint& point, const Vec3& direction) {
    if (stacked_) {
      media_.cross(object, point.ng, -ray_.direction, direction);
      enter(media_.medium());
    } else if (sees_media_ && object.bounds_media) {
      enter(object.medium_towards(point.ng, direction));
    }
    ray_ = {point.leave(direction), direction};
    free_radius2_ = 0;
  }

  /// Goes straight on behind a surface met at distance t; the end of the ray stays where it was.
  void pass_surface(const Object& object, const SurfacePoint& point, float t) {
    const float t_max = ray_.t_max - t;
    leave(object, point, ray_.direction);
    ray_.t_max = t_max;
  }

  /// Starts `distance` further along, in the same medium.
  void skip(float distance) { ray_ = {ray_.at(distance), ray_.direction, ray_.t_max - distance}; }

  /// What the straight line `line` lets through, which starts here, or at a surface that the walk has arrived at and
  /// leads to either side of it. `throughput` as for pass_straight.
  Passage look_along(const Ray& line, const Spectrum& throughput, const SurfaceEvent* surface = nullptr) const;

 private:
  void enter(const Medium* medium) {
    if (medium == medium_) return;
    medium_ = medium;
    if (!medium) return;
    homogeneous_ = medium->as_homogeneous();
    surroundings_ = &scene_.surroundings(medium);
    free_radius2_ = 0;
  }

  Leg collide(const Vec3& at, const Flight& flight) {
    ray_ = {at, ray_.direction};
    return {true, {}, flight.t, flight.weight, Spectrum(1.0f), flight.emission};
  }

  float end_of_ray() const {
    return surroundings_->bounded ? ray_.t_max : std::min(ray_.t_max, scene_.distance_to_world_end(ray_));
  }

  /// In a medium that is dense for its size most flights end far from any surface: one query for the distance to the
  /// nearest surface then replaces several casts.
  void find_free_ball() {
    free_radius2_ = 0;
    if (!surroundings_->dense) return;
    const float radius = scene_.rays().clearance(ray_.origin, kFreeBallLimit * surroundings_->mean_free_path);
    free_center_ = ray_.origin;
    free_radius2_ = sqr(radius);
  }
  static constexpr float kFreeBallLimit = 8;  ///< mean free paths: a walk rarely gets further before it leaves any ball

  const Scene& scene_;
  Sampler& sampler_;
  SampleCounters& counters_;
  const bool sees_media_;
  const bool stacked_;  ///< media_ decides; else the surface that is crossed

  Ray ray_;
  MediumStack media_;
  const Medium* medium_ = nullptr;
  const HomogeneousMedium* homogeneous_ = nullptr;
  const Surroundings* surroundings_ = nullptr;
  Vec3 free_center_;
  float free_radius2_ = 0;
};

inline Traveller::Leg Traveller::fly(const Spectrum& throughput) {
  const Spectrum mix = channel_mix(throughput);
  if (homogeneous_) {
    // The distance first, the cast after: a short flight makes for a short cast, or none within a ball known to be
    // free.
    const Flight flight = homogeneous_->flight(kInfinity, mix, sampler_.next_1d());
    const float t = flight.collides ? flight.t : kInfinity;
    const Vec3 end = ray_.at(t);
    if (length_squared(end - free_center_) < free_radius2_) {
      ++counters_.free_flights;
      return collide(end, flight);
    }
    const float limit = end_of_ray();
    ++counters_.rays;
    const Hit hit = scene_.rays().intersect({ray_.origin, ray_.direction, std::min(t, limit)});
    if (!hit && t < limit) {
      const Leg leg = collide(end, flight);
      find_free_ball();
      return leg;
    }
    const float length = hit ? hit.t : limit;
    const Flight passage = homogeneous_->passage(length, mix);
    return {false, hit, length, passage.weight, passage.weight * passage.probability, Spectrum(0.0f)};
  }
  ++counters_.rays;
  const Hit hit = scene_.rays().intersect(ray_);
  const Ray way{ray_.origin, ray_.direction, hit ? hit.t : end_of_ray()};
  const Flight flight = medium_->sample_flight(way, mix, sampler_);
  if (flight.collides) return collide(ray_.at(flight.t), flight);
  return {false, hit, way.t_max, flight.weight, medium_->proxy_transmittance(way), flight.emission};
}

}  // namespace turbid
