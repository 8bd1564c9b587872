#include "table/lobe_field.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <numbers>

#include "core/gauss_legendre.h"
#include "medium/henyey_greenstein.h"
#include "medium/isotropic.h"
#include "table/field_moments.h"
#include "table/tables_for_tests.h"

namespace turbid::testing {
namespace {

using std::numbers::pi;
const Vec3 kAxis(0, 0, 1);

/// int density(x) weight(r, cos) dV out to a radius, by quadrature over cells.
template <class Weight>
double integrate(const LobeField& field, double radius, const Weight& weight) {
  const GaussLegendre rule(4);
  double sum = 0;
  constexpr int kPanels = 96;
  for (int a = 0; a < kPanels; ++a)
    for (int b = 0; b < kPanels; ++b)
      for (size_t i = 0; i < rule.size(); ++i)
        for (size_t j = 0; j < rule.size(); ++j) {
          // Finer near the source and near the axis: r = R x^3, Theta = pi y^2.
          const double x = (a + rule.node(i)) / kPanels, y = (b + rule.node(j)) / kPanels;
          const double r = radius * x * x * x, theta = pi * y * y;
          const double jacobian = 3 * radius * x * x * 2 * pi * y * std::sin(theta) * 2 * pi * r * r;
          const Vec3 p(Imath::V3d(r * std::sin(theta), 0, r * std::cos(theta)));
          sum += rule.weight(i) * rule.weight(j) / kPanels / kPanels * jacobian *
                 static_cast<double>(field.density(p, kAxis)) * weight(r, std::cos(theta));
        }
  return sum;
}

/// Isotropic scattering: sum over n >= from of the light within a radius whose n-th collision lies there, from the
/// transform of n - 1 flights, A^(n-1) with A = atan(k)/k (NUMERICS 8).
double isotropic_content(double albedo, double radius, int from = 3) {
  const double step = 0.02 / std::max(1.0, radius), last = 4000;
  double sum = 0;
  for (double k = step / 2; k < last; k += step) {
    const double a = std::atan(k) / k;
    const double transform = std::pow(albedo, from) * std::pow(a, from - 1) / (1 - albedo * a);
    sum += transform * (std::sin(k * radius) - k * radius * std::cos(k * radius)) / k * step;
  }
  return 2 / pi * sum;
}

// Near the source, on its axis, between cells, at the mirrored ends and in the far field.
TEST(LobeField, EightPlacesAtOnceAreEachByItself) {
  for (const float g : {0.0f, 0.7f}) {
    const LobeField field(small_table(g), SourceKind::kRay, 0.95);
    Rng rng(8);
    const auto direction = [&] {
      const float u = rng.next_float();
      return square_to_sphere({u, rng.next_float()});
    };
    for (int n = 0; n < 300; ++n) {
      const Vec3 axis = direction(), w = direction();
      std::array<Vec3, kLanes> places;
      std::array<LaneRow, 3> rows;
      for (size_t lane = 0; lane < kLanes; ++lane) {
        const float distance = 5e-4f * std::exp(13.5f * rng.next_float());
        places[lane] = (lane == 0 ? axis : lane == 1 ? -axis : direction()) * distance;
        for (int c = 0; c < 3; ++c) rows[static_cast<size_t>(c)][lane] = places[lane][c];
      }
      const LaneRow found =
          to_row(field.eval({load_lanes(rows[0]), load_lanes(rows[1]), load_lanes(rows[2])}, axis, w));
      for (size_t lane = 0; lane < kLanes; ++lane) {
        const float each = field.eval(places[lane], axis, w);
        // Coarse: on the axis the sagittal plane is anybody's, and tiny differences turn it.
        const float most = field.density(places[lane], axis);
        EXPECT_NEAR(found[lane], each, (lane < 2 ? 2e-2f : 1e-3f) * most) << "at " << length(places[lane]);
      }
    }
  }
}

TEST(LobeField, IsotropicScatteringMeetsItsIntegral) {
  const ScatteringTable& table = small_table(0);
  for (const double albedo : {0.5, 0.9, 0.99}) {
    const LobeField field(table, SourceKind::kCollision, albedo);
    for (const double radius : {0.5, 2.0, 8.0, 30.0}) {
      const double expected = isotropic_content(albedo, radius);
      EXPECT_NEAR(integrate(field, radius, [](double, double) { return 1; }) / expected, 1, 0.012)
          << "albedo " << albedo << ", radius " << radius;
    }
  }
  // An oracle that misses an order is noticed.
  const LobeField field(table, SourceKind::kCollision, 0.9);
  EXPECT_GT(isotropic_content(0.9, 2.0) / isotropic_content(0.9, 2.0, 4), 1.1);
  EXPECT_GT(std::abs(integrate(field, 2, [](double, double) { return 1; }) / isotropic_content(0.9, 2.0, 4) - 1), 0.1);
}

TEST(LobeField, FromHigherOrders) {
  for (const int from : {3, 4, 5}) {
    const LobeField field(small_table(0), SourceKind::kCollision, 0.9, from);
    EXPECT_NEAR(measure_moments(field).energy / (std::pow(0.9, from) / 0.1), 1, 2e-3) << from;
    EXPECT_NEAR(integrate(field, 2.0, [](double, double) { return 1; }) / isotropic_content(0.9, 2.0, from), 1, 0.012);
  }
}

TEST(LobeField, HasTheEnergyOfItsOrders) {
  for (const float g : {0.0f, 0.7f})
    for (const SourceKind kind : {SourceKind::kCollision, SourceKind::kRay})
      for (const double albedo : {0.1, 0.5, 0.8, 0.95, 0.99, 0.999}) {
        const LobeField field(small_table(g), kind, albedo);
        EXPECT_NEAR(measure_moments(field).energy / (std::pow(albedo, 3) / (1 - albedo)), 1, 5e-3)
            << "g " << g << ", albedo " << albedo;
      }
}

TEST(LobeField, HasTheMomentsOfTheClosedForms) {
  for (const float g : {0.0f, 0.7f})
    for (const SourceKind kind : {SourceKind::kCollision, SourceKind::kRay})
      for (const double albedo : {0.5, 0.9, 0.97}) {
        const LobeField field(small_table(g), kind, albedo);
        const FieldMoments found = measure_moments(field);
        const FieldMoments exact = exact_moments(static_cast<double>(g), albedo, kind);
        EXPECT_NEAR(found.square / exact.square, 1, 0.02) << g << " " << albedo;
        EXPECT_NEAR(found.along, exact.along, 0.01 * std::sqrt(exact.square)) << g << " " << albedo;
        // Another integral says the same.
        EXPECT_NEAR(integrate(field, 200, [](double r, double) { return r * r; }) / found.energy, found.square,
                    0.01 * found.square);
        // The other kind of source is found out.
        const bool ray = kind == SourceKind::kRay;
        const FieldMoments other =
            exact_moments(static_cast<double>(g), albedo, ray ? SourceKind::kCollision : SourceKind::kRay);
        if (albedo < 0.97) {
          EXPECT_GT(std::abs(found.square / other.square - 1), 0.05);
        }
      }
}

TEST(LobeField, EndsInTheDiffuseFarField) {
  const double albedo = 0.99, g = static_cast<double>(0.7f);
  const LobeField field(small_table(0.7f), SourceKind::kCollision, albedo);
  const double d = 1 / (3 * (1 - g * albedo)), k = std::sqrt(3 * (1 - albedo) * (1 - g * albedo));
  const double centre = g / (1 - g * albedo);
  // Over the diffusion approximation with this decay, the mean over directions.
  const auto ratio = [&](double r, double decay) {
    double sum = 0;
    constexpr int kSteps = 32;
    for (int i = 0; i < kSteps; ++i) {
      const double c = -1 + 2 * (i + 0.5) / kSteps;
      const double from_centre = std::sqrt(r * r - 2 * r * centre * c + centre * centre);
      const Vec3 x(Imath::V3d(r * std::sqrt(1 - c * c), 0, r * c));
      sum += static_cast<double>(field.density(x, kAxis)) /
             (albedo * albedo * std::exp(-decay * from_centre) / (4 * pi * d * from_centre)) / kSteps;
    }
    return sum;
  };
  for (const double r : {15.0, 25.0, 40.0}) EXPECT_NEAR(ratio(r, k), 1, 0.05) << r;
  // Beyond the edge, at 60 mean free paths, the decay is that of transport.
  const double exact = decay_rate(small_table(0.7f).moments, albedo);
  EXPECT_NEAR(ratio(150, exact) / ratio(61, exact), 1, 0.01);
  EXPECT_GT(std::abs(ratio(150, k) / ratio(61, k) - 1), 0.03);
}

TEST(LobeField, HighOrdersHaveFewBands) {
  TableShape shape{PolarGrid(12, 10, 60), {12, 3}};
  const std::vector<OrderBin> bins = simulate_orders(HenyeyGreensteinPhase(0.7f), shape, {1, 4000});
  const auto light_in_band = [&](const OrderBin& bin, size_t l) {
    double sum = 0;
    for (size_t cell = 0; cell < shape.grid.cell_count(); ++cell)
      sum += std::abs(static_cast<double>(bin.moments[0][cell * shape.cell_size() + l * SagittalHarmonics::kOrders]));
    return sum;
  };
  EXPECT_GT(light_in_band(bins.front(), 12), 0);
  EXPECT_GT(light_in_band(bins.back(), 2), 0);
  EXPECT_EQ(light_in_band(bins.back(), 3), 0) << "noise";
}

TEST(LobeField, IsTheSameForAnyNumberOfThreads) {
  const IsotropicPhase phase;
  const TableShape shape{PolarGrid(12, 10, 60), {0, 0}};
  const auto build = [&](size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return build_table(phase, shape, {5, 2000});
  };
  const ScatteringTable one = build(1), two = build(2);
  EXPECT_EQ(one.kinds[0].density, two.kinds[0].density);
  EXPECT_EQ(one.kinds[1].ratios, two.kinds[1].ratios);
  EXPECT_NE(one.kinds[0].density, build_table(phase, shape, {6, 2000}).kinds[0].density);
}

TEST(LobeField, RefusesWhatItCannotHold) {
  EXPECT_THROW(LobeField(small_table(0), SourceKind::kRay, 0.9999), std::invalid_argument);
  EXPECT_THROW(LobeField(small_table(0), SourceKind::kRay, -0.1), std::invalid_argument);
  EXPECT_THROW(LobeField(small_table(0), SourceKind::kRay, 0.5, 2), std::invalid_argument);
}

TEST(LobeField, IsFiniteAndNotNegativeEverywhere) {
  Rng rng(2);
  const auto direction = [&] { return square_to_sphere({rng.next_float(), rng.next_float()}); };
  for (const double albedo : {0.0, 1e-4, 0.3, 0.9, 0.9995}) {
    const LobeField field(small_table(0.7f), SourceKind::kRay, albedo);
    EXPECT_TRUE(std::isfinite(field.eval(Vec3(0), kAxis, direction())));
    for (int i = 0; i < 2000; ++i) {
      const Vec3 x = direction() * std::exp(16 * rng.next_float() - 8);
      const float value = field.eval(x, i % 3 == 0 ? normalize(x) : direction(), direction());
      EXPECT_TRUE(value >= 0 && std::isfinite(value)) << value;
    }
  }
}

}  // namespace
}  // namespace turbid::testing
