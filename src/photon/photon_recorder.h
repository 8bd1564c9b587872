#pragma once
#include "photon/photon_map.h"
#include "refraction/refractive_scattering.h"

namespace turbid {

/// What walks from lights are to leave.
struct PhotonSettings {
  bool collisions = false;     ///< in homogeneous media
  bool inhomogeneous = false;  ///< collisions in other media
  bool surfaces = false;
  bool beams = false;
  bool long_beams = false;  ///< reach to the next surface, and carry what is left of the flux; else to the collision
};

/// Recorder of walks from lights that leaves photons.
class PhotonRecorder : public LightRecorder {
 public:
  /// `refraction`: counts some of the light; may be null.
  PhotonRecorder(const Scene& scene, const StrategyWeights& weights, const PhotonSettings& settings,
                 const RefractiveScattering* refraction, SampleCounters& counters)
      : LightRecorder(scene, weights),
        settings_(settings),
        counted_(RefractiveScattering::counted_light(refraction)),
        counters_(counters) {}

  /// The next path; `beams`: it leaves beams, where the settings ask for any.
  void begin(bool beams, Photons& result) {
    beams_ = beams && settings_.beams;
    result_ = &result;
  }

  void at_emitter(const Emission& emission, const Traveller& traveller);
  void on_segment(const Ray& way, const Medium& medium, const PathState& state, const Traveller::Leg& leg);
  void at_surface(const SurfaceEvent& event, const PathState& state, const Traveller& traveller);
  void at_collision(const CollisionEvent& event, const PathState& state, const Traveller& traveller);
  void left_surface(const SurfaceEvent& event, const BsdfSample& sample, const Vec3& chosen, const PathState& state,
                    const Traveller& traveller);

 private:
  PhotonSettings settings_;
  CountedLight counted_;
  SampleCounters& counters_;
  Photons* result_ = nullptr;
  bool beams_ = false;
};

}  // namespace turbid
