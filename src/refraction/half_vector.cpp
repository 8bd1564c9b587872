#include "refraction/half_vector.h"

#include <algorithm>
#include <cmath>

namespace turbid {
namespace {

constexpr int kMaxSteps = 30;
/// In (a, b), and in t relative to the triangle's size: S4 Fig. 12 shows what a loose one does through D.
constexpr double kTolerance = 1e-11;
constexpr double kFarAway = 100;  ///< sizes of the triangle
constexpr double kZero = 1e-6;    ///< of |f|, which is an angle: Newton also rests where |f| is least but not 0

/// The derivative of v / |v| where v changes by dv (S4 eq. 15).
V3d unit_change(const V3d& unit, double norm, const V3d& dv) { return (dv - unit * unit.dot(dv)) / norm; }

/// The least-squares solution x of x.x u + x.y v = -f; empty where u and v are parallel.
std::optional<V2d> newton_step(const V3d& f, const V3d& u, const V3d& v) {
  const double uu = u.length2(), uv = u.dot(v), vv = v.length2(), determinant = uu * vv - uv * uv;
  if (!(determinant > 1e-24 * uu * vv)) return std::nullopt;
  const double fu = f.dot(u), fv = f.dot(v);
  return V2d(-(fu * vv - fv * uv), -(fv * uu - fu * uv)) / determinant;
}

}  // namespace

V3d HalfVector::value(double t, const V2d& at) const {
  const V3d p = facet_.position(at);
  const V3d to_light = light_.at_infinity ? light_.place : (light_.place - p).normalized();
  return ((line_.at(t) - p).normalized() * eta_ + to_light).normalized() + facet_.normal(at) * sign_;
}

HalfVector::Jacobian HalfVector::jacobian(double t, const V2d& at) const {
  const V3d p = facet_.position(at), to_v = line_.at(t) - p;
  const double distance_v = to_v.length();
  const V3d w_v = to_v / distance_v;
  const V3d towards = light_.at_infinity ? light_.place : light_.place - p;
  const double distance_l = towards.length();
  const V3d w_l = towards / distance_l;
  const V3d h = w_v * eta_ + w_l;
  const double norm = h.length();
  const V3d unit = h / norm, blended = facet_.blended_normal(at);
  const auto by_position = [&](const V3d& dp, const V3d& dn) {
    const V3d dv = unit_change(w_v, distance_v, -dp);
    const V3d dl = light_.at_infinity ? V3d(0) : unit_change(w_l, distance_l, -dp);
    return unit_change(unit, norm, dv * eta_ + dl) + Facet::normal_change(blended, dn) * sign_;
  };
  const V3d by_t = unit_change(unit, norm, unit_change(w_v, distance_v, line_.direction) * eta_);
  return {unit + blended.normalized() * sign_,
          {by_t, by_position(facet_.p_a, facet_.n_a), by_position(facet_.p_b, facet_.n_b)}};
}

std::optional<V2d> HalfVector::solve(double t, const V2d& start, double tolerance) const {
  V2d at = start;
  for (int i = 0; i < kMaxSteps; ++i) {
    const Jacobian j = jacobian(t, at);
    const auto step = newton_step(j.value, j.columns[1], j.columns[2]);
    if (!step) return std::nullopt;
    at += *step;
    if (!(at.length() < kFarAway)) return std::nullopt;
    if (step->length() < tolerance)
      return value(t, at).length() < std::max(kZero, tolerance) ? std::optional(at) : std::nullopt;
  }
  return std::nullopt;
}

std::optional<HalfVector::Crossing> HalfVector::solve_on_side(Side side, const Crossing& start) const {
  // The side is at(u) = begin + u way.
  const V2d begin = side == Side::kC ? V2d(1, 0) : V2d(0, 0);
  const V2d way = side == Side::kA ? V2d(0, 1) : side == Side::kB ? V2d(1, 0) : V2d(-1, 1);
  const double size = (facet_.p_a * way.x + facet_.p_b * way.y).length();
  double t = start.t, u = (start.at - begin).dot(way) / way.length2();
  for (int i = 0; i < kMaxSteps; ++i) {
    const Jacobian j = jacobian(t, begin + way * u);
    const auto step = newton_step(j.value, j.columns[0] * size, j.columns[1] * way.x + j.columns[2] * way.y);
    if (!step) return std::nullopt;
    t += step->x * size;
    u += step->y;
    if (!(std::abs(u) < kFarAway)) return std::nullopt;
    if (step->length() < kTolerance)
      return value(t, begin + way * u).length() < kZero ? std::optional(Crossing{t, begin + way * u}) : std::nullopt;
  }
  return std::nullopt;
}

V3d HalfVector::tangent(const Jacobian& jacobian) {
  // All columns are perpendicular to N, so the rows span a plane; the longest product of two of them is its normal.
  const auto row = [&](int k) { return V3d(jacobian.columns[0][k], jacobian.columns[1][k], jacobian.columns[2][k]); };
  const std::array<V3d, 3> products = {row(0).cross(row(1)), row(1).cross(row(2)), row(2).cross(row(0))};
  return *std::max_element(products.begin(), products.end(),
                           [](const V3d& x, const V3d& y) { return x.length2() < y.length2(); });
}

}  // namespace turbid
