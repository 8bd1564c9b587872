#pragma once
#include <array>
#include <optional>
#include <vector>

#include "refraction/pencil.h"

namespace turbid {

/// The part of a line with from <= t <= to.
struct Segment {
  Line line;
  double from, to;
};

/// A stretch of the curve of all points of a facet whose refracted rays meet a line (S4 sect. 3.2.2; there the curve is
/// that of f(t, a, b) = 0). Here it is the contour meeting(a, b) = 0, which knows neither t nor a starting point: it is
/// found by signs, and along it nothing is singular where V passes a caustic (t turns back there).
///
/// In the (a, b) plane it is a graph over the direction perpendicular to `across`, from `start` to `end`.
struct ContourPiece {
  V2d start, end;
  V2d across;                  ///< unit vector, along which meeting() changes
  std::array<V2d, 3> corners;  /// of the part of the facet that it crosses
  double from = 0, to = 1;     ///< the part of it, as a share of the way from start to end, that belongs to the segment

  /// Length of the whole piece as measured across `across`, in the (a, b) plane.
  double width() const { return std::abs((end - start).cross(across)); }
};

/// A point of a piece.
struct ContourPoint {
  V2d at;
  Pencil::Differential there;
  double slope;         ///< derivative of meeting() along `across`
  Encounter encounter;  ///< with the line
};

/// Finds the pieces of a facet's contour, and points on them. TriangleFilter tells cheaply which facets have none.
///
/// The facet is cut into similar parts until meeting() on each is nearly the quadratic function through its values at
/// corners and middles of sides, and that has a gradient of one direction; then signs at corners tell everything. What
/// is still not so after kMaxDepth cuts is taken as if it were, and counted.
class ContourFinder {
 public:
  /// The pieces within the segment; valid until the next call.
  const std::vector<ContourPiece>& find(const Pencil& pencil, const Segment& segment);

  /// The point at the share x in [from, to] of a piece; empty where the solver does not converge. `tolerance`: of its
  /// last step, in the (a, b) plane.
  static std::optional<ContourPoint> point(const Pencil& pencil, const Line& line, const ContourPiece& piece, double x,
                                           double tolerance = 1e-10);

  /// Parts that find() had to give up on, since construction.
  uint64_t unresolved() const { return unresolved_; }

 private:
  struct Node {
    V2d at;
    double value = 0;  ///< of meeting()
    bool lit = false;  ///< Pencil::valid
    double cos_refracted = 0;
  };
  static constexpr int kMaxDepth = 8;
  /// Next to the critical angle, where cos_refracted falls to 0 like a root and its square weighs what comes through.
  static constexpr int kMaxCriticalDepth = 5;

  Node node(const V2d& at) const;
  void search(const Node& q0, const Node& q1, const Node& q2, double scale, int depth);
  void add_piece(const std::array<Node, 3>& corners, const std::array<Node, 3>& middles, const V2d& across);
  /// The root of meeting() on the side between two nodes of different sign.
  V2d root_on_side(const Node& a, const Node& middle, const Node& b) const;
  /// Restricts a piece to the segment; false where nothing is left.
  bool clip(ContourPiece& piece) const;

  const Pencil* pencil_ = nullptr;
  const Segment* segment_ = nullptr;
  std::vector<ContourPiece> pieces_;
  uint64_t unresolved_ = 0;
};

}  // namespace turbid
