// Refraction at one triangle: the refracted ray, the half-vector function, the distance factor, and that they agree.
#include <gtest/gtest.h>

#include <numbers>

#include "refraction/distance_factor.h"
#include "refraction/half_vector.h"
#include "refraction/random_facets.h"

namespace turbid::testing {
namespace {

constexpr int kCases = 500;

/// A valid refracted ray of a random facet, with a point V on it and a line through V.
struct Situation {
  Facet facet;
  LightPoint light;
  double eta = 1;
  V2d at;
  Pencil::Ray ray;
  double s = 0, t = 0;
  V3d v;
  Line line;
};

template <class Check>
void for_random_situations(uint64_t seed, double bend, const Check& check) {
  RandomFacets random(seed);
  int valid = 0;
  while (valid < kCases) {
    Situation now;
    now.facet = random.facet(bend);
    now.light = random.light(random.uniform(0, 1) < 0.3);
    now.eta = random.eta();
    now.at = random.inside();
    const Pencil pencil(now.facet, now.light, now.eta);
    now.ray = pencil.ray(now.at);
    now.s = random.uniform(0.2, 2);
    now.t = random.uniform(0.1, 1);
    now.v = now.ray.p + now.ray.direction * now.s;
    now.line = random.line_through(now.v, now.t);
    if (!pencil.valid(now.ray) || now.ray.cos_light < 0.1 || now.ray.cos_refracted < 0.1) continue;
    ++valid;
    check(now, pencil);
  }
}

TEST(Pencil, ObeysSnellsLaw) {
  for_random_situations(1, 0.3, [](const Situation& now, const Pencil&) {
    const Pencil::Ray& ray = now.ray;
    EXPECT_NEAR(ray.direction.length(), 1, 1e-12);
    EXPECT_NEAR(-ray.direction.dot(ray.normal), ray.cos_refracted, 1e-12);
    // eta sin_T = sin_L, in one plane with N, on the other side.
    EXPECT_NEAR(((ray.direction * now.eta + ray.to_light).cross(ray.normal)).length(), 0, 1e-12);
  });
}

TEST(Pencil, DerivativesAreThoseOfItsRays) {
  for_random_situations(2, 0.3, [](const Situation& now, const Pencil& pencil) {
    constexpr double kStep = 1e-6;
    const Pencil::Differential there = pencil.differential(now.at);
    const auto slope = [&](const V2d& step) {
      const auto after = pencil.ray(now.at + step), before = pencil.ray(now.at - step);
      return std::pair((after.direction - before.direction) / (2 * kStep),
                       (meeting(after, now.line) - meeting(before, now.line)) / (2 * kStep));
    };
    const auto [by_a, h_a] = slope({kStep, 0});
    const auto [by_b, h_b] = slope({0, kStep});
    EXPECT_LT((by_a - there.direction_a).length(), 1e-7 * (1 + by_a.length()));
    EXPECT_LT((by_b - there.direction_b).length(), 1e-7 * (1 + by_b.length()));
    const V2d gradient = meeting_gradient(there, now.line);
    EXPECT_LT((gradient - V2d(h_a, h_b)).length(), 1e-7 * (1 + gradient.length()));
  });
}

TEST(Pencil, MeetsTheLineWhereItPasses) {
  for_random_situations(3, 0.3, [](const Situation& now, const Pencil&) {
    EXPECT_NEAR(meeting(now.ray, now.line), 0, 1e-12);
    const Encounter met = encounter(now.ray, now.line);
    EXPECT_NEAR(met.on_line, now.t, 1e-6);
    EXPECT_NEAR(met.on_ray, now.s, 1e-6);
  });
}

TEST(HalfVector, IsZeroOnRefractedPaths) {
  for_random_situations(4, 0.3, [](const Situation& now, const Pencil&) {
    const HalfVector function(now.facet, now.light, now.eta, now.line);
    EXPECT_LT(function.value(now.t, now.at).length(), 1e-9) << "eta " << now.eta;
    const HalfVector wrong_sign(now.facet, now.light, 1 / now.eta, now.line);
    EXPECT_GT(wrong_sign.value(now.t, now.at).length(), 1e-3);
  });
}

TEST(HalfVector, JacobianIsItsDerivative) {
  for_random_situations(5, 0.3, [](const Situation& now, const Pencil&) {
    const HalfVector function(now.facet, now.light, now.eta, now.line);
    const double t = now.t + 0.1;  // off the zero
    const HalfVector::Jacobian j = function.jacobian(t, now.at);
    EXPECT_LT((j.value - function.value(t, now.at)).length(), 1e-12);
    constexpr double kStep = 1e-6;
    const V3d by_t = function.value(t + kStep, now.at) - function.value(t - kStep, now.at);
    const V3d by_a = function.value(t, now.at + V2d(kStep, 0)) - function.value(t, now.at - V2d(kStep, 0));
    const V3d by_b = function.value(t, now.at + V2d(0, kStep)) - function.value(t, now.at - V2d(0, kStep));
    const V3d numeric[] = {by_t / (2 * kStep), by_a / (2 * kStep), by_b / (2 * kStep)};
    for (size_t k = 0; k < 3; ++k)
      EXPECT_LT((j.columns[k] - numeric[k]).length(), 1e-6 * (1 + numeric[k].length())) << k;
  });
}

TEST(HalfVector, NewtonFindsThePathAndTheTangentFollowsTheCurve) {
  int found = 0;
  for_random_situations(6, 0.1, [&](const Situation& now, const Pencil& pencil) {
    const HalfVector function(now.facet, now.light, now.eta, now.line);
    const auto at = function.solve(now.t, now.at + V2d(0.05, -0.03));
    if (!at || (*at - now.at).length() > 1e-8) return;  // another root, or none: near a caustic
    ++found;
    // Along the tangent f stays 0 to second order.
    const V3d g = HalfVector::tangent(function.jacobian(now.t, now.at)).normalized();
    constexpr double kStep = 1e-4;
    const V2d step(g.y * kStep, g.z * kStep);
    EXPECT_LT(function.value(now.t + g.x * kStep, now.at + step).length(), 1e-5);
    // It is the contour's direction.
    const V2d gradient = meeting_gradient(pencil.differential(now.at), now.line);
    EXPECT_NEAR(gradient.dot(V2d(g.y, g.z)) / gradient.length(), 0, 1e-6);
  });
  EXPECT_GT(found, kCases * 9 / 10);
}

TEST(HalfVector, FindsPointsOfTheCurveOnSides) {
  RandomFacets random(7);
  int tried = 0, found = 0;
  while (tried < kCases) {
    const Facet facet = random.facet(0.1);
    const LightPoint light = random.light();
    const double eta = random.eta(), u = random.uniform(0, 1);
    const Pencil pencil(facet, light, eta);
    const V2d at(u, 0);
    const Pencil::Ray ray = pencil.ray(at);
    if (!pencil.valid(ray)) continue;
    const Line line = random.line_through(ray.p + ray.direction, 0.5);
    ++tried;
    const HalfVector function(facet, light, eta, line);
    const auto crossing = function.solve_on_side(HalfVector::Side::kB, {0.55, {u + 0.05, 0}});
    found += crossing && std::abs(crossing->t - 0.5) < 1e-7 && (crossing->at - at).length() < 1e-7;
  }
  EXPECT_GT(found, kCases * 9 / 10);
}

RefractedPath path_of(const Situation& now) { return {now.v, now.ray.p, now.ray.normal, now.at, now.eta, now.light}; }

/// Where the ray from V in the direction w arrives, refracted at the facet's interpolated normal, and its direction.
std::pair<V3d, V3d> arrival(const Situation& now, const V3d& w) {
  const Facet& f = now.facet;
  const V3d across = f.p_a.cross(f.p_b);
  const V3d p = now.v + w * ((f.p0 - now.v).dot(f.ng) / w.dot(f.ng));
  const V2d at((p - f.p0).cross(f.p_b).dot(across) / across.length2(),
               f.p_a.cross(p - f.p0).dot(across) / across.length2());
  const V3d n = f.normal(at);
  const double cos_v = w.dot(n);
  const V3d out = w * now.eta + n * (std::sqrt(1 - sqr(now.eta) * (1 - sqr(cos_v))) - now.eta * cos_v);
  return {p, out};
}

TEST(DistanceFactor, IsTheFiniteDifferenceOfArrivals) {
  double worst = 0;
  for_random_situations(8, 0.3, [&](const Situation& now, const Pencil&) {
    const V3d w = (now.ray.p - now.v).normalized(), u = w.cross(V3d(0.3, 0.9, -0.2)).normalized(), v = w.cross(u);
    constexpr double kStep = 1e-5;
    const auto slope = [&](const V3d& axis) {
      const auto [p1, d1] = arrival(now, (w + axis * kStep).normalized());
      const auto [p0, d0] = arrival(now, (w - axis * kStep).normalized());
      return ((now.light.at_infinity ? d1 - d0 : (p1 + d1 * now.ray.distance) - (p0 + d0 * now.ray.distance)) /
              (2 * kStep));
    };
    const double numeric = std::abs(slope(u).cross(slope(v)).dot(now.ray.to_light));
    const double analytic = distance_factor(now.facet, path_of(now));
    worst = std::max(worst, std::abs(analytic - numeric) / std::max(numeric, 1e-2));
  });
  RecordProperty("worst", std::to_string(worst));
  EXPECT_LT(worst, 1e-5);
}

TEST(DistanceFactor, HasAClosedFormForConstantNormals) {
  for_random_situations(9, 0, [](const Situation& now, const Pencil&) {
    const double exact =
        flat_distance_factor(now.s, now.ray.distance, now.ray.cos_refracted, now.ray.cos_light, now.eta);
    const double d = distance_factor(now.facet, path_of(now));
    if (now.light.at_infinity)  // the limit of D / d_L^2
      EXPECT_NEAR(d, sqr(now.eta) * now.ray.cos_refracted / now.ray.cos_light, 1e-9 * d);
    else
      EXPECT_NEAR(d, exact, 1e-9 * exact);
  });
  EXPECT_NEAR(flat_distance_factor(0.7, 1.3, 1, 1, 1.5), 7.0225, 1e-12);
}

TEST(Contour, SlopeIsTheDistanceFactorInOtherCoordinates) {
  // dt eta^2 / D = dsigma flux area2 / slope, for shading normals too.
  RandomFacets random(10);
  int compared = 0, lost = 0;
  while (compared < kCases) {
    const Facet facet = random.facet(0.2);
    const LightPoint light = random.light();
    const double eta = random.eta();
    const Pencil pencil(facet, light, eta);
    const V2d through = random.inside();
    const Pencil::Ray middle = pencil.ray(through);
    if (!pencil.valid(middle)) continue;
    const Segment segment{random.line_through(middle.p + middle.direction * random.uniform(0.2, 2), 0.5), 0, 1};
    ContourFinder finder;
    for (const ContourPiece& piece : finder.find(pencil, segment)) {
      const double x = (piece.from + piece.to) / 2, dx = 1e-4 * (piece.to - piece.from);
      const auto at = ContourFinder::point(pencil, segment.line, piece, x);
      const auto before = ContourFinder::point(pencil, segment.line, piece, x - dx);
      const auto after = ContourFinder::point(pencil, segment.line, piece, x + dx);
      if (!at || !before || !after) {
        ++lost;  // beyond the critical angle
        continue;
      }
      const Pencil::Ray& ray = at->there.ray;
      if (!pencil.valid(ray) || ray.cos_refracted < 0.1 || !(at->encounter.on_ray > 0.05)) continue;
      const double dt = std::abs(after->encounter.on_line - before->encounter.on_line);
      const V3d v = segment.line.at(at->encounter.on_line);
      const double d = distance_factor(facet, {v, ray.p, ray.normal, at->at, eta, light});
      const double by_distance = dt * sqr(eta) / d;
      const double flux = ray.cos_light * -ray.direction.dot(facet.ng) / (ray.cos_refracted * sqr(ray.distance));
      const double by_contour = piece.width() * 2 * dx * flux * facet.area2 / at->slope;
      EXPECT_NEAR(by_distance / by_contour, 1, 1e-4);
      ++compared;
    }
  }
  EXPECT_LT(lost, compared / 20);
}

}  // namespace
}  // namespace turbid::testing
