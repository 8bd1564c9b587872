#include "refraction/position_normal_tree.h"

#include <algorithm>
#include <numbers>
#include <numeric>
#include <stdexcept>

namespace turbid {
namespace {

constexpr double kHalfPi = std::numbers::pi / 2;

/// All points P + s w with P in the ball, s >= 0 and w within an angle of the axis: the part of [from, to] of a line in
/// there, or a little more. `sine`, `cosine` of the angle, which is below 90 degrees.
PositionNormalTree::Interval cut_by_shaft(const V3d& center, double radius, const V3d& axis, double sine, double cosine,
                                          const Line& line, double from, double to) {
  // With q = V - C, z = q . axis and rho the distance from the axis: rho cosine - z sine <= radius. That function of t
  // is convex; squared: cosine^2 q^2 - z^2 - 2 radius sine z - radius^2 <= 0 where radius + sine z >= 0.
  const V3d q = line.origin - center;
  const double z0 = q.dot(axis), zd = line.direction.dot(axis), qd = q.dot(line.direction);
  const double a = sqr(cosine) - sqr(zd), b = sqr(cosine) * qd - z0 * zd - radius * sine * zd,
               c = sqr(cosine) * q.length2() - sqr(z0) - 2 * radius * sine * z0 - sqr(radius);
  constexpr double kFlat = 1e-9;
  if (std::abs(a) < kFlat) return std::pair(from, to);
  const double discriminant = b * b - a * c;
  const auto forwards = [&](double t) { return radius + sine * (z0 + zd * t) >= 0; };
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
      most_deviation(kHalfPi - std::asin(std::min(index_ratio, 1 / index_ratio))) {}

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
  double spread = 0;
  if (!query.light.at_infinity) {
    u -= center;
    const double distance = u.length();
    if (distance <= radius) return std::pair(from, to);
    u /= distance;
    spread = asin_bound(radius / distance);
  }

  // However it is bent: the spindle (S4 sect. 3.2.4), seen from the light.
  Interval part = std::pair(from, to);
  const double loosest = spread + query.most_deviation;
  if (loosest < kHalfPi) part = cut_by_shaft(center, radius, -u, std::sin(loosest), std::cos(loosest), line, from, to);
  if (!part || cone + spread >= kHalfPi) return part;

  // Bent at one of the normals: angles of incidence up to `most`, at least `least`.
  V3d axis = V3d(node.axis) * query.sign;
  const double cosine = std::clamp(axis.dot(u), -1.0, 1.0), incidence = std::acos(cosine);
  const double least = incidence - spread - cone;
  if (least >= kHalfPi) return std::nullopt;
  double of_axis = incidence, around = cone;
  if (incidence > kHalfPi) {  // the nearest normal that the light shines on stands for the axis
    axis = (axis - u * cosine).normalized();
    around += incidence - kHalfPi;
    of_axis = kHalfPi;
  }
  const double most = std::min(incidence + spread + cone, kHalfPi);
  // Turning the light by an angle turns what is refracted by up to `by_light` times that, turning the normal by up to
  // `by_normal` times: in the plane of incidence d theta_T / d theta_L = cos_L / (eta cos_T) and 1 minus that; across
  // it 1 / eta, and the length of the bend |cos_L / eta - cos_T|. All are extreme at an end of the range of incidence.
  const double sin_most = std::sin(most) * query.inverse_eta;
  constexpr double kNearCritical = 0.98;
  if (query.eta < 1) {
    if (least > 0 && std::sin(least) * query.inverse_eta >= 1) return std::nullopt;  // totally reflected
    if (sin_most > kNearCritical) return part;
  }
  const double cos_most = std::cos(most), cos_refracted = std::sqrt(1 - sqr(sin_most));
  const double ratio = cos_most * query.inverse_eta / cos_refracted;
  const double bend = std::abs(cos_most * query.inverse_eta - cos_refracted);
  const double by_light = std::max(query.inverse_eta, ratio);
  const double by_normal = std::max({std::abs(1 - ratio), std::abs(1 - query.inverse_eta), bend});
  const double opening = by_light * spread + by_normal * around;
  if (opening >= kHalfPi) return part;
  const double cos_axis = std::cos(of_axis),
               cos_axis_refracted = std::sqrt(1 - sqr(std::sin(of_axis) * query.inverse_eta));
  const V3d refracted = axis * (cos_axis * query.inverse_eta - cos_axis_refracted) - u * query.inverse_eta;
  return cut_by_shaft(center, radius, refracted.normalized(), std::sin(opening), std::cos(opening), line, part->first,
                      part->second);
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
