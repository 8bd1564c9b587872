#pragma once
#include "gathering/gather_settings.h"
#include "gathering/gather_volume.h"
#include "path/walk.h"

namespace turbid {

/// Radii in proportion to pixels: those of a sensor's rays through its middle, `pixels` wide.
GatherRadius radius_in_pixels(const Scene& scene, float pixels);

/// From the origin of a way through a medium to the next surface, or to the end of the world.
float length_to_surface(const Scene& scene, const Ray& way, const Medium& medium, SampleCounters& counters);

/// What all walks of one image share.
struct GatherPlan {
  const Scene& scene;
  const PathSettings& path;
  const GatherSettings& gather;
  GatherRadius volume_radius, disk_radius;
  bool has_rough_surfaces;  ///< else walks end where the last volume stands
};

/// Recorder of walks from the sensor. They go through mirrors, glass and media, leave volumes at collisions or along
/// flights, and end at the first rough surface z: there they ask for direct light, and leave a disk for all other. What
/// comes to z is taken there; the light of paths without z by the volumes; lights seen straight or in mirrors by the
/// walk. So each path counts once.
class SensorGatherer : public WalkRecorder {
 public:
  SensorGatherer(const GatherPlan& plan, Sampler& sampler, SampleCounters& counters)
      : plan_(plan), sampler_(sampler), counters_(counters) {}

  /// The next walk, for this pixel of the crop window; what it leaves is added to `result`.
  void begin(uint32_t pixel, const SensorRay& camera, Gathering& result) {
    pixel_ = pixel;
    result_ = &result;
    last_event_ = camera.ray.origin;
    walked_ = 0;
    ended_ = beyond_rough_ = scattered_ = false;
    by_chance_ = true;
  }

  void on_segment(const Ray& way, const Medium& medium, const PathState& state, const Traveller::Leg& leg);
  void at_surface(const SurfaceEvent& event, const PathState& state, const Traveller& traveller);
  void at_collision(const CollisionEvent& event, const PathState& state, const Traveller& traveller);
  void left_surface(const SurfaceEvent& event, const BsdfSample& sample, const Vec3&, const PathState&,
                    const Traveller&);
  void left_collision(const CollisionEvent& event, float, const Vec3&, const PathState& state, const Traveller&);
  void at_light(const Hit&, const Object& object, const SurfacePoint& point, const PathState& state,
                const Traveller& traveller);
  void at_escape(const PathState& state, const Traveller& traveller);
  bool goes_on() const { return !ended_; }

 private:
  void place_spheres(const Ray& way, const HomogeneousMedium& medium, const PathState& state, bool collides);
  void place_cylinder(const Ray& way, const HomogeneousMedium& medium, const PathState& state);
  void place_flights(const Ray& way, const Medium& medium, const PathState& state, const Traveller::Leg& leg);
  void place(GatherVolume volume, const Medium& medium, const PathState& state, float distance);
  void arrive(const Vec3& p) {
    walked_ += length(p - last_event_);
    last_event_ = p;
  }
  /// Does light count that the walk meets by chance?
  bool chance_counts(const PathState& state) const;
  void ask_for_light(const Vertex& vertex, const Traveller& traveller);
  void find(const Spectrum& value, int light_vertices, int sensor_vertices, int order);

  const GatherPlan& plan_;
  Sampler& sampler_;
  SampleCounters& counters_;
  Gathering* result_ = nullptr;
  uint32_t pixel_ = 0;
  Vec3 last_event_;   ///< where the walk last changed its direction ...
  float walked_ = 0;  ///< ... and the way to there
  bool ended_ = false;
  bool beyond_rough_ = false;  ///< the walk goes on behind z and asks for light
  bool scattered_ = false;     ///< at a rough surface or a collision
  bool by_chance_ = true;      ///< the last choice of direction left no other: only chance finds what lies there
};

}  // namespace turbid
