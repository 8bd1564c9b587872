#include "photon/photon_recorder.h"

#include "gathering/sensor_gatherer.h"

namespace turbid {

void PhotonRecorder::at_emitter(const Emission& emission, const Traveller& traveller) {
  LightRecorder::at_emitter(emission, traveller);
  counted_.left(*emission.emitter);
  if (beams_) result_->emissions.push_back(emission);
}

void PhotonRecorder::on_segment(const Ray& way, const Medium& medium, const PathState& state,
                                const Traveller::Leg& leg) {
  const HomogeneousMedium* homogeneous = medium.as_homogeneous();
  if (beams_ && homogeneous && !homogeneous->sigma_s().is_black() && !state.throughput.is_black()) {
    LightSegment segment{way, state.throughput, settings_.long_beams, channel_mix(state.throughput)};
    if (segment.is_long && leg.collides) segment.ray.t_max = length_to_surface(scene_, way, medium, counters_);
    if (segment.ray.t_max > 0)
      result_->beams.push_back({segment, homogeneous, edge_, straight_,
                                static_cast<uint32_t>(result_->emissions.size() - 1), state.depth, state.order,
                                counted_.may_collide(medium), state.visit_order});
  }
  LightRecorder::on_segment(way, medium, state, leg);
}

void PhotonRecorder::at_surface(const SurfaceEvent& event, const PathState& state, const Traveller&) {
  current_ = arrive({event.point.p, Spectrum(1.0f), std::abs(dot(event.point.ng, event.given))}, state);
  if (!settings_.surfaces || !(event.object.bsdf->flags() & lobe::kSmooth)) return;
  PhotonPoint& photon = result_->surfaces.emplace_back(event.point.p, -event.given, state, weights_, current_);
  photon.ng = event.point.ng;
  photon.bent = counted_.is_bent();
}

void PhotonRecorder::left_surface(const SurfaceEvent& event, const BsdfSample& sample, const Vec3& chosen,
                                  const PathState& state, const Traveller& traveller) {
  LightRecorder::left_surface(event, sample, chosen, state, traveller);
  counted_.left_surface(event, sample, traveller.medium_towards(event, chosen));
}

void PhotonRecorder::at_collision(const CollisionEvent& event, const PathState& state, const Traveller&) {
  current_ = arrive({event.position, event.medium.proxy_sigma_t(event.position)}, state);
  counted_.collided(event.medium);
  if (!(event.medium.as_homogeneous() ? settings_.collisions : settings_.inhomogeneous)) return;
  PhotonPoint& photon = result_->collisions.emplace_back(event.position, event.direction, state, weights_, current_);
  photon.medium = &event.medium;
  photon.bent = counted_.is_bent();
}

}  // namespace turbid
