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

/// A vertex as the end of an edge, see end_factor.
struct EdgeEnd {
  Vec3 position;
  Spectrum events;
  float cosine = 1;
};

/// An edge of a walk that has left a vertex and may end anywhere.
struct OpenEdge {
  EdgeEnd from;
  StrategySums sums;              ///< there ...
  StrategyWeights::Departure by;  ///< ... and how it was left

  /// end_factor at the beginning; `straight`: what the edge lets through, as a stand-in.
  double back_factor(const Spectrum& straight) const { return end_factor(from.events, from.cosine, straight); }
  /// The sums at an end of it.
  StrategySums sums_at(const StrategyWeights& weights, const EdgeEnd& end, const Spectrum& straight) const {
    const double inverse = inverse_square(end.position, from.position);
    return weights.next(sums, by, inverse * end_factor(end.events, end.cosine, straight),
                        inverse * back_factor(straight));
  }
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
      by = {false, static_cast<double>(sample.pdf_w), static_cast<double>(back.pdf_w), weights_.merged_at_surface()};
    }
    depart({event.point.p, Spectrum(1.0f), std::abs(dot(event.point.ng, chosen))}, by);
  }
  void left_collision(const CollisionEvent& event, float mu, const Vec3&, const PathState&, const Traveller&) {
    const auto f = static_cast<double>(event.medium.phase().eval(mu));
    depart({event.position, event.medium.proxy_sigma_t(event.position), 1},
           {false, f, f, merges_at(weights_, event.medium, mu).sum()});
  }

 protected:
  static constexpr TransportMode kOpposite =
      kMode == TransportMode::kRadiance ? TransportMode::kImportance : TransportMode::kRadiance;

  /// The sums at a vertex that the walk arrives at from another one.
  StrategySums sums_at(const EdgeEnd& end) const { return edge_.sums_at(weights_, end, straight_); }

  const StrategyWeights& weights_;
  StrategySums current_;  ///< at the vertex where the walk is
  OpenEdge edge_;         ///< that it left

 private:
  void depart(const EdgeEnd& from, const StrategyWeights::Departure& by) {
    edge_ = {from, current_, by};
    start_edge();
  }
};

}  // namespace turbid
