#include "refraction/contour.h"

#include <algorithm>

#include "refraction/quadratic.h"

namespace turbid {
namespace {

/// Steps of bracketed root search before giving up; secant steps converge in three or four.
constexpr int kMaxSteps = 60;

/// How t changes along the contour in the direction `v` of the (a, b) plane, which must be tangent to it.
double change_on_line(const ContourPoint& point, const Line& line, const V2d& v) {
  const Pencil::Differential& d = point.there;
  const V3d change = d.p_a * v.x + d.p_b * v.y + (d.direction_a * v.x + d.direction_b * v.y) * point.encounter.on_ray;
  const V3d across = d.ray.direction.cross(line.direction);
  return d.ray.direction.cross(change).dot(across) / across.length2();
}

/// The direction of the contour at a point, such that it leads from the start of its piece to its end.
V2d tangent(const ContourPoint& point, const Line& line, const ContourPiece& piece) {
  const V2d g = meeting_gradient(point.there, line), along(-g.y, g.x);
  return along.dot(piece.end - piece.start) < 0 ? -along : along;
}

}  // namespace

ContourFinder::Node ContourFinder::node(const V2d& at) const {
  const Pencil::Ray ray = pencil_->ray(at);
  return {at, meeting(ray, segment_->line), pencil_->valid(ray), ray.cos_refracted};
}

const std::vector<ContourPiece>& ContourFinder::find(const Pencil& pencil, const Segment& segment) {
  pencil_ = &pencil;
  segment_ = &segment;
  pieces_.clear();
  search(node({0, 0}), node({1, 0}), node({0, 1}), 1, 0);
  return pieces_;
}

void ContourFinder::search(const Node& q0, const Node& q1, const Node& q2, double scale, int depth) {
  const Node m01 = node((q0.at + q1.at) * 0.5), m12 = node((q1.at + q2.at) * 0.5), m20 = node((q2.at + q0.at) * 0.5);
  if (!(q0.lit || q1.lit || q2.lit || m01.lit || m12.lit || m20.lit)) return;
  const Quadratic model({q0.value, q1.value, q2.value}, {m01.value, m12.value, m20.value});
  if (model.keeps_its_sign()) return;

  // One direction across for the whole part: the gradient must not turn away from its mean.
  constexpr double kLeastShare = 0.25;
  const std::array<V2d, 3> gradients = model.gradients();
  const V2d mean = (gradients[0] + gradients[1] + gradients[2]) * (1.0 / 3);
  const bool one_way = std::all_of(gradients.begin(), gradients.end(),
                                   [&](const V2d& g) { return g.dot(mean) >= kLeastShare * mean.length2(); });
  const auto [low, high] = std::minmax(
      {q0.cos_refracted, q1.cos_refracted, q2.cos_refracted, m01.cos_refracted, m12.cos_refracted, m20.cos_refracted});
  const bool critical = pencil_->eta() < 1 && low < high - low;
  const bool simple = one_way && mean.length2() > 0 && !model.may_cross_a_side_twice() && !critical;
  if (!simple && depth < (critical ? kMaxCriticalDepth : kMaxDepth)) {
    search(q0, m01, m20, scale / 2, depth + 1);
    search(m01, q1, m12, scale / 2, depth + 1);
    search(m20, m12, q2, scale / 2, depth + 1);
    search(m12, m20, m01, -scale / 2, depth + 1);  // turned by half a turn: the sides stay parallel
    return;
  }
  const bool crosses = signs_differ(q0.value, q1.value) || signs_differ(q0.value, q2.value);
  if (!simple && crosses) ++unresolved_;
  if (crosses && mean.length2() > 0)
    add_piece({q0, q1, q2}, {m01, m12, m20}, mean * (std::copysign(1 / mean.length(), scale)));
}

void ContourFinder::add_piece(const std::array<Node, 3>& corners, const std::array<Node, 3>& middles,
                              const V2d& across) {
  std::array<V2d, 2> ends;
  size_t found = 0;
  for (size_t k = 0; k < 3; ++k) {
    const Node &a = corners[k], &b = corners[(k + 1) % 3];
    if (signs_differ(a.value, b.value) && found < 2) ends[found++] = root_on_side(a, middles[k], b);
  }
  ContourPiece piece{ends[0], ends[1], across, {corners[0].at, corners[1].at, corners[2].at}};
  if (piece.width() > 0 && clip(piece)) pieces_.push_back(piece);
}

V2d ContourFinder::root_on_side(const Node& a, const Node& middle, const Node& b) const {
  // The contour's ends only say where to integrate: errors of so much of a side are no matter.
  constexpr double kTolerance = 1e-7;
  // The quadratic through the three values, and a step of Newton's with its slope: enough where it is nearly right.
  const double bend = 2 * (a.value + b.value - 2 * middle.value), linear = b.value - a.value - bend;
  const double root = std::sqrt(std::max(0.0, linear * linear - 4 * bend * a.value));
  const double guess = 2 * -a.value / (linear + std::copysign(root, linear));
  if (guess >= 0 && guess <= 1) {
    const double step =
        -meeting(pencil_->ray(a.at + (b.at - a.at) * guess), segment_->line) / (linear + 2 * bend * guess);
    constexpr double kNearlyRight = 1e-3;
    if (std::abs(step) < kNearlyRight) return a.at + (b.at - a.at) * std::clamp(guess + step, 0.0, 1.0);
  }
  // The half with the root, then secants that keep the bracket (the Illinois rule: Dowell & Jarratt 1971).
  const bool first = signs_differ(a.value, middle.value);
  double x0 = first ? 0 : 0.5, x1 = first ? 0.5 : 1;
  double y0 = first ? a.value : middle.value, y1 = first ? middle.value : b.value;
  const V2d way = b.at - a.at;
  double x = x0;
  int side = 0;
  for (int i = 0; i < kMaxSteps && x1 - x0 > kTolerance; ++i) {
    const double next = (x0 * y1 - x1 * y0) / (y1 - y0);
    const bool settled = std::abs(next - x) < kTolerance;
    x = next;
    if (settled) break;
    const double y = meeting(pencil_->ray(a.at + way * x), segment_->line);
    if (y == 0) break;
    if (signs_differ(y, y0)) {
      x1 = x;
      y1 = y;
      if (side == 1) y0 /= 2;
      side = 1;
    } else {
      x0 = x;
      y0 = y;
      if (side == -1) y1 /= 2;
      side = -1;
    }
  }
  return a.at + way * x;
}

bool ContourFinder::clip(ContourPiece& piece) const {
  const double from = segment_->from, to = segment_->to;
  const auto within = [&](const Encounter& e) { return e.on_line >= from && e.on_line <= to && e.on_ray > 0; };
  if (within(encounter(pencil_->ray(piece.start), segment_->line)) &&
      within(encounter(pencil_->ray(piece.end), segment_->line)))
    return true;
  const auto start = point(*pencil_, segment_->line, piece, 0), end = point(*pencil_, segment_->line, piece, 1);
  if (!start || !end) return true;
  const double t0 = start->encounter.on_line, t1 = end->encounter.on_line;

  // Only where t goes one way is it known what lies between; elsewhere (a caustic, a ray parallel to the line) the
  // whole piece stays, and points beyond the segment count nothing.
  const double d0 = change_on_line(*start, segment_->line, tangent(*start, segment_->line, piece)),
               d1 = change_on_line(*end, segment_->line, tangent(*end, segment_->line, piece));
  if (!(d0 * d1 > 0 && d0 * (t1 - t0) > 0)) return true;
  if (std::max(t0, t1) < from || std::min(t0, t1) > to) return false;
  if (start->encounter.on_ray < 0 && end->encounter.on_ray < 0) return false;
  const auto share_at = [&](double t, double otherwise) {
    if ((t0 < t) == (t1 < t)) return otherwise;
    constexpr double kTolerance = 1e-7;
    double x0 = 0, x1 = 1, y0 = t0 - t, y1 = t1 - t;
    for (int i = 0; i < kMaxSteps && x1 - x0 > kTolerance; ++i) {
      // Secants, and every third time the middle, in case they creep.
      const double x = i % 3 == 2 ? (x0 + x1) / 2 : std::clamp((x0 * y1 - x1 * y0) / (y1 - y0), x0, x1);
      const auto there = point(*pencil_, segment_->line, piece, x);
      if (!there) return otherwise;
      const double y = there->encounter.on_line - t;
      if (std::abs(y) < kTolerance * std::abs(t1 - t0)) return x;
      (signs_differ(y, y0) ? x1 : x0) = x;
      (signs_differ(y, y0) ? y1 : y0) = y;
    }
    return (x0 + x1) / 2;
  };
  const bool forwards = t0 < t1;
  piece.from = share_at(forwards ? from : to, 0);
  piece.to = share_at(forwards ? to : from, 1);
  return piece.to > piece.from;
}

std::optional<ContourPoint> ContourFinder::point(const Pencil& pencil, const Line& line, const ContourPiece& piece,
                                                 double x, double tolerance) {
  // Newton along `across`, kept between the sides of the part.
  const V2d base = piece.start + (piece.end - piece.start) * x;
  double low = -kInfinity, high = kInfinity;
  for (size_t k = 0; k < 3; ++k) {
    const V2d &a = piece.corners[k], side = piece.corners[(k + 1) % 3] - a;
    // Inside where side x (at - a) >= 0, for corners that go round counter-clockwise, as all parts do.
    const double height = side.cross(base - a), slope = side.cross(piece.across);
    if (slope > 0) low = std::max(low, -height / slope);
    if (slope < 0) high = std::min(high, -height / slope);
  }
  constexpr double kSlack = 1e-6;
  low = std::min(low, 0.0) - kSlack;
  high = std::max(high, 0.0) + kSlack;
  double at = 0;
  for (int i = 0; i < kMaxSteps; ++i) {
    const V2d place = base + piece.across * at;
    const Pencil::Differential there = pencil.differential(place);
    const double value = meeting(there.ray, line), slope = meeting_gradient(there, line).dot(piece.across);
    (value < 0 ? low : high) = at;  // meeting() rises along `across`
    const double step = slope > 0 ? -value / slope : 0;
    const bool converged = std::abs(step) < tolerance || value == 0;
    if (converged && slope > 0) return ContourPoint{place, there, slope, encounter(there.ray, line)};
    const double newton = at + step;
    const bool usable = slope > 0 && newton > low && newton < high;
    const double next = usable ? newton : (low + high) / 2;
    if (next == at || !(high > low)) return std::nullopt;
    at = next;
  }
  return std::nullopt;
}

}  // namespace turbid
