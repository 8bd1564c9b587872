#pragma once
#include "path/join.h"
#include "path/walk.h"

namespace turbid {

/// Keeps the StrategySums of a walk up to date: what both subpaths of bidirectional methods share. A recorder derives
/// from it, asks for sums_at() at each vertex (but the first, whose density is that of the walk's start), and hands
/// them on when the walk leaves the vertex.
///
/// Densities here are those of a mixture of the channels that depends on the medium alone, not on the throughput as the
/// flights themselves do: any weights that add up to 1 are right, and these can be found from either end.
class SubpathRecorder : public WalkRecorder {
 public:
  explicit SubpathRecorder(const StrategyWeights& weights) : weights_(weights) {}

  void on_segment(const Ray& way, const Medium& medium, const PathState&, const Traveller::Leg& leg) {
    if (leg.collides) straight_ *= medium.proxy_transmittance(way);
  }
  void passed_medium(const Spectrum& proxy) { straight_ *= proxy; }
  void passed_surface(const Spectrum& through) { straight_ *= through; }

 protected:
  void start_edge() { straight_ = Spectrum(1.0f); }

  /// The sums at a vertex that the walk arrives at, `events` and `cosine` as for end_factor.
  StrategySums sums_at(const Vec3& position, const Spectrum& events, float cosine) const {
    const double inverse = inverse_square(position, last_position_);
    return weights_.next(last_, departure_, inverse * end_factor(events, cosine, straight_), inverse * back_factor());
  }
  /// The walk leaves a vertex with these sums.
  void depart(const Vec3& position, const Spectrum& events, float cosine, const StrategySums& sums,
              const StrategyWeights::Departure& by) {
    last_position_ = position;
    last_events_ = events;
    last_cosine_ = cosine;
    last_ = sums;
    departure_ = by;
    start_edge();
  }
  void depart(const SurfaceEvent& event, const BsdfSample& sample, const Vec3& chosen, const StrategySums& sums,
              TransportMode mode) {
    StrategyWeights::Departure by;
    if (!(sample.flags & lobe::kDelta)) {
      const TransportMode opposite =
          mode == TransportMode::kRadiance ? TransportMode::kImportance : TransportMode::kRadiance;
      const Bsdf::Eval back = event.object.bsdf->eval(event.point, sample.direction, event.given_local, opposite);
      by = {false, static_cast<double>(sample.pdf_w), static_cast<double>(back.pdf_w)};
    }
    depart(event.point.p, Spectrum(1.0f), std::abs(dot(event.point.ng, chosen)), sums, by);
  }
  void depart(const CollisionEvent& event, float mu, const StrategySums& sums, const Spectrum& events) {
    const auto f = static_cast<double>(event.medium.phase().eval(mu));
    depart(event.position, events, 1, sums, {false, f, f});
  }

  /// end_factor of the last edge at its beginning.
  double back_factor() const { return end_factor(last_events_, last_cosine_, straight_); }
  const StrategyWeights& weights_;
  Spectrum straight_{1.0f};  ///< proxies along the edge so far
  Vec3 last_position_;       ///< of the vertex that the edge began at ...
  Spectrum last_events_;
  float last_cosine_ = 1;
  StrategySums last_;
  StrategyWeights::Departure departure_;  ///< ... and how it was left
};

}  // namespace turbid
