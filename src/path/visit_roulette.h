#pragma once
#include <algorithm>
#include <vector>

#include "core/rng.h"
#include "path/events.h"

namespace turbid {

/// Ends most walks from lights that have scattered often in one visit to certain media, where what they bring next is
/// known from elsewhere: what still comes out and goes on is little, far away and dear. One walk in `1 / share` goes
/// on, and weighs so much more. A walk is asked once: where light enters again and again, as in milk, a few would else
/// weigh hundreds of times as much as all others, each in a colour of its own, for channels part on long ways.
class VisitRoulette {
 public:
  static constexpr float kShare = 0.1f;
  static constexpr int kOften = 4;  ///< collisions

  explicit VisitRoulette(std::vector<const Medium*> media, float share = kShare)
      : media_(std::move(media)), share_(share) {}

  /// For a new walk; the choice draws from `rng`.
  void begin(const Rng& rng) {
    rng_ = rng;
    scale_ = 1;
    ended_ = false;
  }
  void left_collision(const Medium& medium, const PathState& state) {
    if (scale_ > 1 || state.visit_order != kOften || !holds(&medium)) return;
    if (rng_.next_float() < share_)
      scale_ /= share_;
    else
      ended_ = true;
  }
  bool goes_on() const { return !ended_; }
  /// Of what the walk carries now.
  float scale() const { return scale_; }
  bool holds(const Medium* medium) const { return std::find(media_.begin(), media_.end(), medium) != media_.end(); }

 private:
  std::vector<const Medium*> media_;
  float share_;
  Rng rng_;
  float scale_ = 1;
  bool ended_ = false;
};

}  // namespace turbid
