#pragma once
#include <span>

#include "refraction/contour.h"

namespace turbid {

/// Tells, of up to eight triangles at once, which of them a contour may cross, by meeting() at corners and middles of
/// sides: the first question of ContourFinder, whose answer is mostly no. Corners and sides that triangles share are
/// computed for each of them: eight in a register cost less than looking them up.
class TriangleFilter {
 public:
  static constexpr size_t kLanes = 8;

  /// `eta`: index where the refracted light goes / index at the light; `flipped`: the light stands on the inside.
  TriangleFilter(const TriangleMesh& mesh, const LightPoint& light, double eta, bool flipped, const Segment& segment)
      : mesh_(mesh), light_(light), inverse_eta_(1 / eta), sign_(flipped ? -1 : 1), segment_(segment) {}

  /// A bit for each of the triangles; at most kLanes. Not set where the light stands inside, where no light passes, or
  /// where the contour stays away: meeting() is of one sign and far from 0 for what it may do between the corners, or
  /// for what the quadratic function through the six values leaves out (Quadratic::keeps_its_sign).
  uint32_t may_contribute(std::span<const uint32_t> triangles) const;

 private:
  const TriangleMesh& mesh_;
  LightPoint light_;
  double inverse_eta_, sign_;
  Segment segment_;
};

}  // namespace turbid
