#include "refraction/position_normal_tree.h"

#include <algorithm>
#include <numbers>
#include <numeric>
#include <stdexcept>

namespace turbid {
namespace {

constexpr double kHalfPi = std::numbers::pi / 2;

/// Angles below which the series of sine_of and cosine_of are good to 1e-6; larger ones are taken for no bound at all.
constexpr double kLargeAngle = 1.2;
/// For angles in [0, kLargeAngle], within 5e-7.
double sine_of(double x) {
  const double x2 = x * x;
  return x * (1 - x2 / 6 * (1 - x2 / 20 * (1 - x2 / 42 * (1 - x2 / 72))));
}
double cosine_of(double x) {
  const double x2 = x * x;
  return 1 - x2 / 2 * (1 - x2 / 12 * (1 - x2 / 30 * (1 - x2 / 56 * (1 - x2 / 90))));
}

/// All points P + s w with P in a ball, s >= 0 and w within an angle below 90 degrees of the axis.
struct Shaft {
  V3d center;
  double radius;
  V3d axis;
  double sine, cosine;  ///< of the angle
};

/// The part of [from, to] of a line in a shaft, or a little more.
PositionNormalTree::Interval cut_by_shaft(const Shaft& shaft, const Line& line, double from, double to) {
  const auto& [center, radius, axis, sine, cosine] = shaft;
  // With q = V - C, z = q . axis and rho the distance from the axis: rho cosine - z sine <= radius. That function of t
  // is convex; squared: cosine^2 q^2 - z^2 - 2 radius sine z - radius^2 <= 0 where radius + sine z >= 0.
  const V3d q = line.origin - center;
  const double z0 = q.dot(axis), zd = line.direction.dot(axis), qd = q.dot(line.direction);
  const double a = sqr(cosine) - sqr(zd), b = sqr(cosine) * qd - z0 * zd - radius * sine * zd,
               c = sqr(cosine) * q.length2() - sqr(z0) - 2 * radius * sine * z0 - sqr(radius);
  constexpr double kFlat = 1e-9;
  if (std::abs(a) < kFlat) return std::pair(from, to);
  const double discriminant = b * b - a * c;
  const auto forwards = [&, r = radius, turn = sine](double t) { return r + turn * (z0 + zd * t) >= 0; };
  double first = from, last = to;
  if (a > 0) {
    if (discriminant < 0) return std::nullopt;
    const double root = std::sqrt(discriminant);
    if (!forwards(-b / a)) return std::nullopt;
    first = (-b - root) / a;
    last = (-b + root) / a;
  } else if (discriminant < 0) {
    // Through the tip of both nappes: one half of the line.
    if (sine > 0) (zd > 0 ? first : last) = (-radius / sine - z0) / zd;
  } else {
    const double root = std::sqrt(discriminant);
    const double low = (-b + root) / a, high = (-b - root) / a;  // a < 0
    if (zd > 0)
      first = high;
    else
      last = low;
  }
  if (first > to || last < from || first > last) return std::nullopt;
  return std::pair(std::max(first, from), std::min(last, to));
}

/// asin(x) or a little more, x in [0, 1].
double asin_bound(double x) { return x * (1 + (kHalfPi - 1) * x * x); }

}  // namespace

PositionNormalTree::Query::Query(const LightPoint& light_point, double index_ratio, bool light_inside)
    : light(light_point),
      eta(index_ratio),
      inverse_eta(1 / index_ratio),
      sign(light_inside ? -1 : 1),
      cos_deviation(std::min(index_ratio, 1 / index_ratio)),
      sin_deviation(std::sqrt(1 - sqr(cos_deviation))) {}

PositionNormalTree::PositionNormalTree(const TriangleMesh& mesh) : triangles_(mesh.triangle_count()) {
  std::iota(triangles_.begin(), triangles_.end(), 0u);
  nodes_.reserve(2 * triangles_.size() / kLeafSize + 1);
  build(mesh, triangles_, 0);
  nodes_.shrink_to_fit();
}

void PositionNormalTree::build(const TriangleMesh& mesh, std::span<uint32_t> triangles, uint32_t first) {
  const size_t index = nodes_.size();
  nodes_.push_back(bound(mesh, triangles));
  if (triangles.size() <= kLeafSize) {
    nodes_[index].begin = first;
    nodes_[index].count = static_cast<uint32_t>(triangles.size());
    return;
  }
  const MeshData& data = mesh.data();
  const auto middle = [&](uint32_t triangle) {
    const uint32_t* i = &data.indices[3 * size_t{triangle}];
    return data.positions[i[0]] + data.positions[i[1]] + data.positions[i[2]];
  };
  Bounds3 box;
  for (const uint32_t triangle : triangles) box.extendBy(middle(triangle));
  const int axis = static_cast<int>(box.majorAxis());
  const size_t half = triangles.size() / 2;
  std::nth_element(triangles.begin(), triangles.begin() + static_cast<std::ptrdiff_t>(half), triangles.end(),
                   [&](uint32_t x, uint32_t y) {
                     const float mx = middle(x)[axis], my = middle(y)[axis];
                     return mx < my || (mx == my && x < y);
                   });
  build(mesh, triangles.first(half), first);
  const auto second = static_cast<uint32_t>(nodes_.size());
  build(mesh, triangles.subspan(half), first + static_cast<uint32_t>(half));
  nodes_[index].begin = second;
  nodes_[index].count = 0;
}

PositionNormalTree::Node PositionNormalTree::bound(const TriangleMesh& mesh, std::span<const uint32_t> triangles) {
  const MeshData& data = mesh.data();
  Bounds3 box;
  V3d sum(0);
  const auto for_corners = [&](const auto& see) {
    for (const uint32_t triangle : triangles) {
      const Facet facet = facet_of(mesh, triangle);
      for (size_t k = 0; k < 3; ++k) {
        const V2d at(k == 1, k == 2);
        see(data.positions[data.indices[3 * size_t{triangle} + k]], facet.normal(at));
      }
    }
  };
  for_corners([&](const Vec3& p, const V3d& n) {
    box.extendBy(p);
    sum += n;
  });
  Node node{};
  node.center = box.center();
  node.axis = sum.length() > 0 ? Vec3(sum.normalized()) : Vec3(0, 0, 1);
  double radius2 = 0, least_cosine = 1;
  for_corners([&](const Vec3& p, const V3d& n) {
    radius2 = std::max(radius2, (V3d(p) - V3d(node.center)).length2());
    least_cosine = std::min(least_cosine, n.dot(V3d(node.axis)));
  });
  constexpr double kSlack = 1e-6;  // for the rounding to float
  node.radius = static_cast<float>(std::sqrt(radius2) * (1 + kSlack));
  // A blend of normals stays in their cone as long as that is convex; the cosine of a small angle is inexact.
  node.angle =
      static_cast<float>(least_cosine > 0 ? std::acos(std::max(least_cosine - 1e-7, 0.0)) + kSlack : std::numbers::pi);
  return node;
}

PositionNormalTree::Interval PositionNormalTree::reach(const Node& node, const Query& query, const Line& line,
                                                       double from, double to) {
  const V3d center(node.center);
  const double radius = static_cast<double>(node.radius), cone = static_cast<double>(node.angle);
  // All directions to the light lie within `spread` of u.
  V3d u = query.light.place;
  double sin_spread = 0;
  if (!query.light.at_infinity) {
    u -= center;
    const double distance = u.length();
    if (distance <= radius) return std::pair(from, to);
    u /= distance;
    sin_spread = radius / distance;
  }
  const double spread = asin_bound(sin_spread);

  // However it is bent: the spindle (S4 sect. 3.2.4), seen from the light.
  const auto loose = [&]() -> Interval {
    const double cos_spread = std::sqrt(1 - sqr(sin_spread));
    const double cosine = query.cos_deviation * cos_spread - query.sin_deviation * sin_spread;
    if (cosine <= 0) return std::pair(from, to);
    const double sine = query.sin_deviation * cos_spread + query.cos_deviation * sin_spread;
    return cut_by_shaft({center, radius, -u, sine, cosine}, line, from, to);
  };
  const double turn = spread + cone;
  if (turn >= kLargeAngle) return loose();

  // Bent at one of the normals: angles of incidence up to `most`.
  V3d axis = V3d(node.axis) * query.sign;
  double cosine = axis.dot(u), around = cone;
  double sine = std::sqrt(std::max(0.0, 1 - sqr(cosine)));
  const double sin_turn = sine_of(turn), cos_turn = cosine_of(turn);
  if (cosine <= 0) {
    if (cosine * cos_turn + sine * sin_turn <= 0) return std::nullopt;  // all normals turn their backs
    around += asin_bound(-cosine);
    axis = (axis - u * cosine) / sine;  // the nearest normal that the light shines on stands for the axis
    cosine = 0;
    sine = 1;
  }
  const double cos_most = std::max(0.0, cosine * cos_turn - sine * sin_turn);
  const double sin2_most = (1 - sqr(cos_most)) * sqr(query.inverse_eta);
  if (query.eta < 1) {
    // At most the critical angle, where light is turned without bound; beyond it none comes through.
    const bool all_reflected =
        sin_turn * cosine < sine && (sine * cos_turn - cosine * sin_turn) * query.inverse_eta >= 1;
    if (all_reflected) return std::nullopt;
    constexpr double kNearCritical = 0.96;
    if (sin2_most > kNearCritical) return loose();
  }
  // Turning the light by an angle turns what is refracted by up to `by_light` times that, turning the normal by up to
  // `by_normal` times: in the plane of incidence d theta_T / d theta_L = cos_L / (eta cos_T) and 1 minus that; across
  // it 1 / eta, and the length of the bend |cos_L / eta - cos_T|. All are extreme at an end of the range of incidence.
  const double cos_refracted = std::sqrt(1 - sin2_most);
  const double ratio = cos_most * query.inverse_eta / cos_refracted;
  const double bend = std::abs(cos_most * query.inverse_eta - cos_refracted);
  const double by_light = std::max(query.inverse_eta, ratio);
  const double by_normal = std::max({std::abs(1 - ratio), std::abs(1 - query.inverse_eta), bend});
  const double opening = by_light * spread + by_normal * around;
  if (opening >= kLargeAngle) return loose();
  const double cos_axis_refracted = std::sqrt(1 - sqr(sine * query.inverse_eta));
  const V3d refracted = axis * (cosine * query.inverse_eta - cos_axis_refracted) - u * query.inverse_eta;
  return cut_by_shaft({center, radius, refracted, sine_of(opening), cosine_of(opening)}, line, from, to);
}

void PositionNormalTree::validate(const TriangleMesh& mesh) const {
  const auto check = [](bool good) {
    if (!good) throw std::logic_error("a node of the position-normal tree does not hold what is below it");
  };
  std::vector<uint32_t> seen = triangles_;
  std::sort(seen.begin(), seen.end());
  for (size_t i = 0; i < seen.size(); ++i) check(seen[i] == i);
  const auto holds = [&](const auto& self, uint32_t index, std::vector<uint32_t>& below) -> uint32_t {
    const Node& node = nodes_[index];
    const size_t first = below.size();
    uint32_t next = index + 1;
    if (node.count > 0) {
      below.insert(below.end(), triangles_.begin() + node.begin, triangles_.begin() + node.begin + node.count);
    } else {
      next = self(self, index + 1, below);
      check(next == node.begin);
      next = self(self, node.begin, below);
    }
    for (size_t i = first; i < below.size(); ++i) {
      const Facet facet = facet_of(mesh, below[i]);
      for (const V2d& at : {V2d(0, 0), V2d(1, 0), V2d(0, 1)}) {
        check((facet.position(at) - V3d(node.center)).length() <= static_cast<double>(node.radius));
        const double cosine = facet.normal(at).dot(V3d(node.axis));
        check(std::acos(std::clamp(cosine, -1.0, 1.0)) <= static_cast<double>(node.angle));
      }
    }
    return next;
  };
  std::vector<uint32_t> below;
  if (!nodes_.empty()) check(holds(holds, 0, below) == nodes_.size());
}

}  // namespace turbid
