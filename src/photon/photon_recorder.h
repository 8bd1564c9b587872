#pragma once
#include "photon/photon_map.h"

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
  PhotonRecorder(const Scene& scene, const StrategyWeights& weights, const PhotonSettings& settings,
                 SampleCounters& counters)
      : LightRecorder(scene, weights), settings_(settings), counters_(counters) {}

  /// The next path; `beams`: it leaves beams, where the settings ask for any.
  void begin(bool beams, Photons& result) {
    beams_ = beams && settings_.beams;
    result_ = &result;
  }

  void at_emitter(const Emission& emission, const Traveller& traveller);
  void on_segment(const Ray& way, const Medium& medium, const PathState& state, const Traveller::Leg& leg);
  void at_surface(const SurfaceEvent& event, const PathState& state, const Traveller& traveller);
  void at_collision(const CollisionEvent& event, const PathState& state, const Traveller& traveller);

 private:
  PhotonSettings settings_;
  SampleCounters& counters_;
  Photons* result_ = nullptr;
  bool beams_ = false;
};

}  // namespace turbid
