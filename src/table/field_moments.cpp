#include "table/field_moments.h"

#include <cmath>
#include <numbers>

#include "core/gauss_legendre.h"

namespace turbid {

FieldMoments measure_moments(const LobeField& field) {
  const GaussLegendre rule(8);
  const PolarGrid& grid = field.grid();
  // Panels between nodes; beyond the edge even ones for 30 decay lengths.
  std::vector<double> radii{0}, cosines;
  const int edge = field.far_field().edge(grid);
  for (int i = 0; i <= edge; ++i) radii.push_back(grid.middle(i));
  for (int step = 1; step <= 20; ++step) radii.push_back(grid.middle(edge) + 1.5 * step / field.far_field().decay());
  for (int j = 0; j <= 2 * grid.angles(); ++j) cosines.push_back(grid.cosine(j / 2.0));
  FieldMoments sum;
  for (size_t i = 0; i + 1 < radii.size(); ++i)
    for (size_t j = 0; j + 1 < cosines.size(); ++j)
      for (size_t a = 0; a < rule.size(); ++a)
        for (size_t b = 0; b < rule.size(); ++b) {
          const double r = std::lerp(radii[i], radii[i + 1], rule.node(a));
          const double mu = std::lerp(cosines[j], cosines[j + 1], rule.node(b));
          const Vec3 x(Imath::V3d(r * std::sqrt(1 - mu * mu), 0, r * mu));
          const double mass = rule.weight(a) * (radii[i + 1] - radii[i]) * rule.weight(b) *
                              (cosines[j] - cosines[j + 1]) * 2 * std::numbers::pi * r * r *
                              static_cast<double>(field.density(x, {0, 0, 1}));
          sum.energy += mass;
          sum.along += mass * r * mu;
          sum.square += mass * r * r;
        }
  return {sum.energy, sum.along / sum.energy, sum.square / sum.energy};
}

FieldMoments exact_moments(double g, double albedo, SourceKind kind, int from_order) {
  FieldMoments sum;
  double weight = std::pow(albedo, from_order);
  const double whole = weight / (1 - albedo);
  for (int n = from_order; weight > 1e-12 * whole; ++n, weight *= albedo) {
    const double k = kind == SourceKind::kRay ? n : n - 1, rest = 1 - std::pow(g, k);
    sum.along += weight * (kind == SourceKind::kRay ? 1 : g) * rest / (1 - g);
    sum.square += weight * (2 * k + 2 * g * (k * (1 - g) - rest) / ((1 - g) * (1 - g)));
  }
  return {whole, sum.along / whole, sum.square / whole};
}

LobeDifference compare_lobes_at(const LightField& a, const LightField& b, const Vec3& x) {
  static const GaussLegendre polar(24);
  constexpr int kAzimuths = 12;
  const Vec3 axis(0, 0, 1), radial = normalize(x), across(radial.z, 0, -radial.x);
  const auto density_a = static_cast<double>(a.density(x, axis)), density_b = static_cast<double>(b.density(x, axis));
  const double equal = density_b > 1e-6 * density_a ? density_a / density_b : 0;
  double square = 0, difference = 0, shape_square = 0, shape_difference = 0;
  for (size_t k = 0; k < polar.size(); ++k)
    for (int n = 0; n < kAzimuths; ++n) {
      // Finer outwards, where the light goes.
      const double v = polar.node(k), theta = std::numbers::pi * v * v;
      const double solid = polar.weight(k) * v * std::sin(theta);
      const double phi = std::numbers::pi * (n + 0.5) / kAzimuths;
      const Vec3 w = radial * static_cast<float>(std::cos(theta)) +
                     across * static_cast<float>(std::sin(theta) * std::cos(phi)) +
                     Vec3(0, static_cast<float>(std::sin(theta) * std::sin(phi)), 0);
      const auto in_a = static_cast<double>(a.eval(x, axis, w)), in_b = static_cast<double>(b.eval(x, axis, w));
      square += solid * (in_a * in_a + in_b * in_b) / 2;
      difference += solid * sqr(in_a - in_b);
      shape_square += solid * (sqr(in_a) + sqr(equal * in_b)) / 2;
      shape_difference += solid * sqr(in_a - equal * in_b);
    }
  const auto root = [](double of, double over) { return over > 0 ? std::sqrt(of / over) : 0; };
  return {root(difference, square), root(2 * sqr(density_a - density_b), sqr(density_a) + sqr(density_b)),
          root(shape_difference, shape_square)};
}

LobeDifference compare_lobes(const LightField& a, const LightField& b, const PolarGrid& grid,
                             const std::function<bool(const Vec3&)>& counts) {
  double energy = 0;
  LobeDifference squares;
  for (int i = 0; i < grid.radii(); ++i)
    for (int j = 0; j < grid.angles(); ++j) {
      // Alternately at the middle of a cell and at its corner.
      const double off = (i + j) % 2 == 0 ? 0.5 : 0.999;
      const double r = grid.radius(i + off), c = grid.cosine(j + off);
      const Vec3 x(Imath::V3d(r * std::sqrt(std::max(0.0, 1 - c * c)), 0, r * c)), axis(0, 0, 1);
      if (counts && !counts(x)) continue;
      const double r0 = grid.radius(i), r1 = grid.radius(i + 1);
      const double mass = static_cast<double>(a.density(x, axis)) * (r1 * r1 * r1 - r0 * r0 * r0) *
                          (grid.cosine(j) - grid.cosine(j + 1));
      if (!(mass > 0)) continue;
      const LobeDifference here = compare_lobes_at(a, b, x);
      energy += mass;
      squares.lobes += mass * sqr(here.lobes);
      squares.shape += mass * sqr(here.shape);
      squares.density += mass * sqr(here.density);
    }
  return {std::sqrt(squares.lobes / energy), std::sqrt(squares.density / energy), std::sqrt(squares.shape / energy)};
}

}  // namespace turbid
