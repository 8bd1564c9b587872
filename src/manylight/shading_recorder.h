#pragma once
#include "path/vertex.h"
#include "path/walk.h"

namespace turbid {

/// Where virtual lights shade: base of recorders of walks from the sensor.
///
/// A path of light from its sensor end is: the sensor, specular vertices, then x, the first vertex that leaves a choice
/// of direction, then its neighbour y. Virtual lights stand for all y that leave a choice of direction, too. What is
/// left for walks to find are paths whose y is a light, or specular: from x they go on, and if the next vertex is
/// specular, the first beyond it with a choice is shaded like x, and so on. So all light counts once.
///
/// Two walks share the paths: one passes through media up to x, a surface, and has on_passage make collisions x on the
/// way; the other scatters, and brings what a walk finds behind a collision x.
class ShadingRecorder : public WalkRecorder {
 public:
  enum class Kind { kPasses, kScatters };
  explicit ShadingRecorder(Kind kind) : kind_(kind) {}

  bool passes_media() const { return kind_ == Kind::kPasses && first_; }
  void left_surface(const SurfaceEvent&, const BsdfSample& sample, const Vec3&, const PathState&, const Traveller&) {
    if (sample.flags & lobe::kDelta) {
      open_ = false;
      return;
    }
    // A first x on a surface belongs to the walk that passes.
    leave(first_ && kind_ == Kind::kScatters);
  }
  void left_collision(const CollisionEvent&, float, const Vec3&, const PathState&, const Traveller&) { leave(false); }
  bool goes_on() const { return !ended_; }

 protected:
  bool scatters() const { return kind_ == Kind::kScatters; }
  /// If the next vertex leaves a choice of direction it is a y.
  bool expects_y() const { return open_; }
  void begin() {
    first_ = true;
    open_ = ended_ = false;
  }
  /// The vertex where the walk is, if it leaves a choice of direction, is one that this walk shades.
  bool shades() const { return !open_ && !leaves_to_other(); }
  /// What this walk finds now, the other one has.
  bool leaves_to_other() const { return first_ && kind_ == Kind::kScatters; }

 private:
  void leave(bool ends) {
    ended_ = ends || open_;
    open_ = true;
    first_ = false;
  }

  Kind kind_;
  bool first_ = true;  ///< x has not come yet
  bool open_ = false;  ///< the current edge began at an x: what is next with a choice of direction is a y
  bool ended_ = false;
};

}  // namespace turbid
