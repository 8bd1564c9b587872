#pragma once
#include "path/join.h"
#include "path/walk.h"

namespace turbid {

/// Keeps what the edge that a walk flies along lets through, as a stand-in that is the same from either end
/// (Passage::proxy).
class EdgeRecorder : public WalkRecorder {
 public:
  void on_segment(const Ray& way, const Medium& medium, const PathState&, const Traveller::Leg& leg) {
    if (leg.collides) straight_ *= medium.proxy_transmittance(way);
  }
  void passed_medium(const Spectrum& proxy) { straight_ *= proxy; }
  void passed_surface(const Spectrum& through) { straight_ *= through; }

 protected:
  void start_edge() { straight_ = Spectrum(1.0f); }

  Spectrum straight_{1.0f};  ///< proxies along the edge so far
};

/// Keeps the StrategySums of a walk up to date: what both subpaths of bidirectional methods share. A recorder derives
/// from it and sets current_ at each vertex: to sums_at(), or at the first one to what the start of its walk says.
///
/// Densities here are those of a mixture of the channels that depends on the medium alone, not on the throughput as the
/// flights themselves do: any weights that add up to 1 are right, and these can be found from either end.
template <TransportMode kMode>
class SubpathRecorder : public EdgeRecorder {
 public:
  explicit SubpathRecorder(const StrategyWeights& weights) : weights_(weights) {}

  void left_surface(const SurfaceEvent& event, const BsdfSample& sample, const Vec3& chosen, const PathState&,
                    const Traveller&) {
    StrategyWeights::Departure by;
    if (!(sample.flags & lobe::kDelta)) {
      const Bsdf::Eval back = event.object.bsdf->eval(event.point, sample.direction, event.given_local, kOpposite);
      by = {false, static_cast<double>(sample.pdf_w), static_cast<double>(back.pdf_w)};
    }
    depart({event.point.p, Spectrum(1.0f), std::abs(dot(event.point.ng, chosen))}, by);
  }
  void left_collision(const CollisionEvent& event, float mu, const Vec3&, const PathState&, const Traveller&) {
    const auto f = static_cast<double>(event.medium.phase().eval(mu));
    depart({event.position, event.medium.proxy_sigma_t(event.position), 1}, {false, f, f});
  }

 protected:
  static constexpr TransportMode kOpposite =
      kMode == TransportMode::kRadiance ? TransportMode::kImportance : TransportMode::kRadiance;

  /// A vertex as the end of an edge, see end_factor.
  struct End {
    Vec3 position;
    Spectrum events;
    float cosine = 1;
  };

  /// The sums at a vertex that the walk arrives at from another one.
  StrategySums sums_at(const End& end) const {
    const double inverse = inverse_square(end.position, last_.position);
    return weights_.next(last_sums_, departure_, inverse * end_factor(end.events, end.cosine, straight_),
                         inverse * back_factor());
  }
  /// end_factor of the last edge at its beginning.
  double back_factor() const { return end_factor(last_.events, last_.cosine, straight_); }

  const StrategyWeights& weights_;
  StrategySums current_;  ///< at the vertex where the walk is
  End last_;              ///< the vertex that the edge began at ...
  StrategySums last_sums_;
  StrategyWeights::Departure departure_;  ///< ... and how it was left

 private:
  void depart(const End& from, const StrategyWeights::Departure& by) {
    last_ = from;
    last_sums_ = current_;
    departure_ = by;
    start_edge();
  }
};

}  // namespace turbid
