#include "refraction/refracted_reach.h"

#include <cmath>
#include <numbers>

#include "refraction/wide.h"

namespace turbid {
namespace {

using namespace wide;

constexpr double kHalfPi = std::numbers::pi / 2;

/// Angles below which the series of sine_of and cosine_of are good to 1e-6; larger ones are taken for no bound at all.
constexpr double kLargeAngle = 1.2;
/// For angles in [0, kLargeAngle], within 5e-7.
Real sine_of(const Real& x) {
  const Real x2 = x * x;
  return x * (1 - x2 / 6 * (1 - x2 / 20 * (1 - x2 / 42 * (1 - x2 / 72))));
}
Real cosine_of(const Real& x) {
  const Real x2 = x * x;
  return 1 - x2 / 2 * (1 - x2 / 12 * (1 - x2 / 30 * (1 - x2 / 56 * (1 - x2 / 90))));
}

/// asin(x) or a little more, x in [0, 1].
Real asin_bound(const Real& x) { return x * (1 + (kHalfPi - 1) * x * x); }

Real root(const Real& x) { return square_root(most(x, all(0))); }

/// All points P + s w with P in a ball, s >= 0 and w within an angle below 90 degrees of the axis.
struct Shaft {
  Vector center;
  Real radius;
  Vector axis;
  Real sine, cosine;  ///< of the angle
};

struct Cut {
  Mask none, whole;  ///< nothing; no bound
  Real first, last;
};

/// The part of a line in a shaft, or a little more; within [from, to] at the ends that it does not bound.
Cut cut_by_shaft(const Shaft& shaft, const Line& line, double from, double to) {
  const auto& [center, radius, axis, sine, cosine] = shaft;
  // With q = V - C, z = q . axis and rho the distance from the axis: rho cosine - z sine <= radius. That function of t
  // is convex; squared: cosine^2 q^2 - z^2 - 2 radius sine z - radius^2 <= 0 where radius + sine z >= 0.
  const Vector q = all(line.origin) - center, d = all(line.direction);
  const Real z0 = dot(q, axis), zd = dot(d, axis), qd = dot(q, d), cosine2 = cosine * cosine;
  const Real a = cosine2 - zd * zd, b = cosine2 * qd - z0 * zd - radius * sine * zd,
             c = cosine2 * dot(q, q) - z0 * z0 - 2 * radius * sine * z0 - radius * radius;
  constexpr double kFlat = 1e-9;
  const Mask flat = magnitude(a) < kFlat;
  const Real discriminant = b * b - a * c, half_width = root(discriminant), inverse = 1 / (flat ? all(1) : a);
  const Mask narrow = a > 0, misses = discriminant<0, forwards = zd> 0;
  const Real low = (-b - half_width) * inverse, high = (-b + half_width) * inverse;  // exchanged where a < 0
  // Steep: from one of two points on, or where the line passes both nappes, from the tip between them.
  const Mask through = ~narrow & misses, bounded = ~(through & (sine <= 0));
  const Real tip = (-radius / (sine > 0 ? sine : all(1)) - z0) / (through ? zd : all(1));
  const Real bound = through ? tip : (forwards ? low : high);
  const Real first = narrow ? low : (forwards & bounded ? bound : all(from));
  const Real last = narrow ? high : (~forwards & bounded ? bound : all(to));
  const Mask backwards = radius + sine * (z0 - zd * b * inverse) < 0;
  return {~flat & ((narrow & (misses | backwards)) | (first > to) | (last < from) | (first > last)), flat, first, last};
}

}  // namespace

RefractionQuery::RefractionQuery(const LightPoint& light_point, double index_ratio, bool light_inside)
    : light(light_point),
      eta(index_ratio),
      inverse_eta(1 / index_ratio),
      sign(light_inside ? -1 : 1),
      cos_deviation(std::min(index_ratio, 1 / index_ratio)),
      sin_deviation(std::sqrt(1 - sqr(cos_deviation))) {}

RefractedReach refracted_reach(const BoundedNormals& bounds, const RefractionQuery& query, const Line& line,
                               double from, double to) {
  const Vector center = load(bounds.center);
  const Real radius = load(bounds.radius), cone = load(bounds.angle);
  // All directions to the light lie within the angle `spread` of u.
  Vector u = all(query.light.place);
  Real sin_spread{};
  Mask inside{};
  if (!query.light.at_infinity) {
    u = u - center;
    const Real distance2 = dot(u, u);
    inside = distance2 <= radius * radius;
    const Real inverse = 1 / square_root(inside ? all(1) : distance2);
    u = u * inverse;
    sin_spread = inside ? all(0) : radius * inverse;
  }
  const Real cos_spread = root(1 - sin_spread * sin_spread), spread = asin_bound(sin_spread);

  // Bent at one of the normals: angles of incidence up to that of `cos_most`.
  const Real turn = spread + cone, bounded_turn = least(turn, all(kLargeAngle));
  Mask loose = turn >= kLargeAngle;
  const Real sin_turn = sine_of(bounded_turn), cos_turn = cosine_of(bounded_turn);
  // A length that rounding to float left off 1 would show in the shaft far away.
  Vector axis = unit(load(bounds.axis)) * all(query.sign);
  Real cosine = dot(axis, u);
  Real sine = root(1 - cosine * cosine);
  const Mask back = cosine <= 0;
  Mask none = back & (cosine * cos_turn + sine * sin_turn <= 0);  // all normals turn their backs
  // The nearest normal that the light shines on stands for an axis that turns its back.
  const Real around = cone + (back ? asin_bound(-cosine) : all(0));
  axis = choose(back, (axis - u * cosine) * (1 / (back ? sine : all(1))), axis);
  cosine = back ? all(0) : cosine;
  sine = back ? all(1) : sine;
  const Real cos_most = most(cosine * cos_turn - sine * sin_turn, all(0));
  const Real sin2_most = (1 - cos_most * cos_most) * sqr(query.inverse_eta);
  if (query.eta < 1)  // beyond the critical angle none comes through
    none |= (sin_turn * cosine < sine) & ((sine * cos_turn - cosine * sin_turn) * query.inverse_eta >= 1);
  none &= ~loose;
  // At most the critical angle, where light is turned without bound.
  constexpr double kNearCritical = 0.96;
  if (query.eta < 1) loose |= sin2_most > kNearCritical;
  // Turning the light by an angle turns what is refracted by up to `by_light` times that, turning the normal by up to
  // `by_normal` times: in the plane of incidence d theta_T / d theta_L = cos_L / (eta cos_T) and 1 minus that; across
  // it 1 / eta, and the length of the bend |cos_L / eta - cos_T|. All are extreme at an end of the range of incidence.
  const Real cos_refracted = square_root(loose ? all(1) : 1 - sin2_most);
  const Real ratio = cos_most * query.inverse_eta / cos_refracted;
  const Real bend = magnitude(cos_most * query.inverse_eta - cos_refracted);
  const Real by_light = most(all(query.inverse_eta), ratio);
  const Real by_normal = most(most(magnitude(1 - ratio), all(std::abs(1 - query.inverse_eta))), bend);
  const Real opening = by_light * spread + by_normal * around;
  loose |= opening >= kLargeAngle;
  const Real bounded_opening = least(opening, all(kLargeAngle));
  const Vector refracted =
      axis * (cosine * query.inverse_eta - root(1 - sine * sine * sqr(query.inverse_eta))) - u * all(query.inverse_eta);

  // However it is bent: the spindle (S4 sect. 3.2.4), seen from the light.
  const Real loose_cosine = query.cos_deviation * cos_spread - query.sin_deviation * sin_spread;
  const Real loose_sine = query.sin_deviation * cos_spread + query.cos_deviation * sin_spread;
  const Cut cut =
      cut_by_shaft({center, radius, choose(loose, -u, refracted), loose ? loose_sine : sine_of(bounded_opening),
                    loose ? loose_cosine : cosine_of(bounded_opening)},
                   line, from, to);
  const Mask whole = inside | cut.whole | (loose & (loose_cosine <= 0));
  RefractedReach result;
  result.lanes = bits(inside | (~none & (whole | ~cut.none)));
  store(whole ? all(from) : most(cut.first, all(from)), result.from);
  store(whole ? all(to) : least(cut.last, all(to)), result.to);
  return result;
}

}  // namespace turbid
