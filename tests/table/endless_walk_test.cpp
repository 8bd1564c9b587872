#include "table/endless_walk.h"

#include <gtest/gtest.h>

#include "medium/henyey_greenstein.h"
#include "medium/tabulated_phase.h"

namespace turbid {
namespace {

/// Means of z and r^2 after `flights`, over pairs that do not share flights, and how uncertain they are.
struct Moments {
  double z = 0, r2 = 0, z_error = 0, r2_error = 0;
};

Moments measure(const PhaseFunction& phase, size_t flights, bool begins_with_flight) {
  constexpr int kRounds = 7500, kPairs = kRounds * static_cast<int>(EndlessWalks::kCount);
  EndlessWalks walks(phase, flights + 1, 7 + flights);
  double z = 0, z2 = 0, r2 = 0, r4 = 0;
  for (int n = 0; n < kRounds; ++n) {
    for (size_t i = 0; i <= flights; ++i) walks.step();
    for (size_t w = 0; w < EndlessWalks::kCount; ++w) {
      const EndlessWalks::Collision& first = walks.back(w, flights);
      // First flight along +z: begins where the ray into that collision began, and has one flight less behind it.
      const EndlessWalks::Collision& last = walks.back(w, begins_with_flight ? 1 : 0);
      const Imath::V3d from = begins_with_flight ? walks.back(w, flights + 1).position : first.position;
      const Imath::V3d x = last.position - from, axis(first.direction);
      const double along = x.dot(axis), squared = x.dot(x);
      z += along;
      z2 += along * along;
      r2 += squared;
      r4 += squared * squared;
    }
  }
  const auto error = [](double sum, double squares) {
    return std::sqrt(std::max(0.0, squares / kPairs - std::pow(sum / kPairs, 2)) / kPairs);
  };
  return {z / kPairs, r2 / kPairs, error(z, z2), error(r2, r4)};
}

double mean_z(double g, size_t k, bool begins_with_flight) {
  return (begins_with_flight ? 1 : g) * (1 - std::pow(g, k)) / (1 - g);
}
double mean_r2(double g, size_t k) {
  const auto n = static_cast<double>(k);
  return 2 * n + 2 * g * (n * (1 - g) - (1 - std::pow(g, k))) / ((1 - g) * (1 - g));
}

double worst_deviation(const PhaseFunction& phase, double g, size_t k, bool begins_with_flight) {
  const Moments m = measure(phase, k, begins_with_flight);
  return std::max(std::abs(m.z - mean_z(g, k, begins_with_flight)) / m.z_error,
                  std::abs(m.r2 - mean_r2(g, k)) / m.r2_error);
}

constexpr double kLevel = 4.2;  ///< standard errors; 64 numbers: one in 600 runs is beyond

TEST(EndlessWalks, MomentsAreThoseOfTheClosedForms) {
  for (const float g : {-0.5f, 0.0f, 0.3f, 0.7f, 0.9f})
    for (const size_t k : {1u, 2u, 5u, 20u})
      for (const bool flight : {false, true})
        EXPECT_LT(worst_deviation(HenyeyGreensteinPhase(g), static_cast<double>(g), k, flight), kLevel)
            << "g " << g << ", " << k << " flights, " << flight;
}

// They depend on the mean cosine alone.
TEST(EndlessWalks, OfOtherPhaseFunctions) {
  const TabulatedPhase table(std::array{2.0f, 0.5f, 0.0f, 0.0f, 1.0f, 6.0f});
  for (const size_t k : {2u, 10u})
    EXPECT_LT(worst_deviation(table, static_cast<double>(table.mean_cosine()), k, false), kLevel);
}

TEST(EndlessWalks, JoinedPassagesHaveTheSameMoments) {
  constexpr int kRounds = 12500, kPassages = kRounds * static_cast<int>(EndlessWalks::kCount);
  for (const float g : {0.0f, 0.7f})
    for (const size_t k : {16u, 37u}) {
      const HenyeyGreensteinPhase phase(g);
      EndlessWalks walks(phase, 30, 1);
      double z = 0, z2 = 0, r2 = 0, r4 = 0, turned = 0, first = 0;
      EndlessWalks::Flights flights;
      flights.fill(k);
      for (int n = 0; n < kRounds; ++n) {
        for (int i = 0; i < 40; ++i) walks.step();
        const EndlessWalks::Passages p = walks.joined(flights);
        const LaneRow forward = to_row(dot(p.displacement, p.axis)),
                      square = to_row(dot(p.displacement, p.displacement)),
                      last = to_row(dot(p.last_direction, p.axis)), before = to_row(dot(p.ray, p.axis));
        for (size_t lane = 0; lane < kLanes; ++lane) {
          const auto along = static_cast<double>(forward[lane]), squared = static_cast<double>(square[lane]);
          z += along;
          z2 += along * along;
          r2 += squared;
          r4 += squared * squared;
          turned += static_cast<double>(last[lane]);
          first += static_cast<double>(before[lane]);
        }
      }
      const double gd = static_cast<double>(g), n = kPassages;
      EXPECT_LT(std::abs(z / n - mean_z(gd, k, false)) / std::sqrt((z2 / n - sqr(z / n)) / n), kLevel);
      EXPECT_LT(std::abs(r2 / n - mean_r2(gd, k)) / std::sqrt((r4 / n - sqr(r2 / n)) / n), kLevel);
      EXPECT_NEAR(turned / n, std::pow(gd, k), kLevel / std::sqrt(3 * n));
      EXPECT_NEAR(first / n, 1, kLevel / std::sqrt(n));
      // One flight more is noticed.
      EXPECT_GT(std::abs(r2 / n - mean_r2(gd, k + 1)) / std::sqrt((r4 / n - sqr(r2 / n)) / n), kLevel);
    }
}

TEST(EndlessWalks, LatestPassagesLieBetweenTheirCollisions) {
  const HenyeyGreensteinPhase phase(0.7f);
  EndlessWalks walks(phase, 20, 3);
  const EndlessWalks::Flights flights{2, 3, 5, 7, 11, 13, 17, 19};
  const EndlessWalks::Passages p = walks.latest(flights);
  for (size_t w = 0; w < EndlessWalks::kCount; ++w) {
    const EndlessWalks::Collision& first = walks.back(w, flights[w]);
    const Vec3 between(walks.back(w, 0).position - first.position),
        ray(first.position - walks.back(w, flights[w] + 1).position);
    EXPECT_EQ(to_row(p.displacement.x)[w], between.x);
    EXPECT_EQ(to_row(p.displacement.z)[w], between.z);
    EXPECT_EQ(to_row(p.ray.y)[w], ray.y);
    EXPECT_EQ(to_row(p.axis.x)[w], first.direction.x);
    EXPECT_EQ(to_row(p.last_direction.y)[w], walks.back(w, 0).direction.y);
    EXPECT_LT(length(normalize(ray) - first.direction), 1e-4f);
  }
}

TEST(EndlessWalks, WrongWalksAreFound) {
  EXPECT_GT(worst_deviation(HenyeyGreensteinPhase(0.72f), 0.7, 20, false), 2 * kLevel);
  // The start of the other closed form.
  const Moments m = measure(HenyeyGreensteinPhase(0.7f), 5, false);
  EXPECT_GT(std::abs(m.z - mean_z(0.7, 5, true)) / m.z_error, 2 * kLevel);
}

}  // namespace
}  // namespace turbid
