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
  constexpr int kPairs = 60000;
  EndlessWalk walk(phase, flights + 1, 7 + flights);
  double z = 0, z2 = 0, r2 = 0, r4 = 0;
  for (int n = 0; n < kPairs; ++n) {
    for (size_t i = 0; i <= flights; ++i) walk.step();
    const EndlessWalk::Collision& first = walk.back(flights);
    // First flight along +z: begins where the ray into that collision began, and has one flight less behind it.
    const EndlessWalk::Collision& last = walk.back(begins_with_flight ? 1 : 0);
    const Imath::V3d from = begins_with_flight ? walk.back(flights + 1).position : first.position;
    const Imath::V3d x = last.position - from, axis(first.direction);
    const double along = x.dot(axis), squared = x.dot(x);
    z += along;
    z2 += along * along;
    r2 += squared;
    r4 += squared * squared;
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

TEST(EndlessWalk, MomentsAreThoseOfTheClosedForms) {
  for (const float g : {-0.5f, 0.0f, 0.3f, 0.7f, 0.9f})
    for (const size_t k : {1u, 2u, 5u, 20u})
      for (const bool flight : {false, true})
        EXPECT_LT(worst_deviation(HenyeyGreensteinPhase(g), static_cast<double>(g), k, flight), kLevel)
            << "g " << g << ", " << k << " flights, " << flight;
}

// They depend on the mean cosine alone.
TEST(EndlessWalk, OfOtherPhaseFunctions) {
  const TabulatedPhase table(std::array{2.0f, 0.5f, 0.0f, 0.0f, 1.0f, 6.0f});
  for (const size_t k : {2u, 10u})
    EXPECT_LT(worst_deviation(table, static_cast<double>(table.mean_cosine()), k, false), kLevel);
}

TEST(EndlessWalk, JoinedPassagesHaveTheSameMoments) {
  constexpr int kPassages = 100000;
  for (const float g : {0.0f, 0.7f})
    for (const size_t k : {16u, 37u}) {
      const HenyeyGreensteinPhase phase(g);
      std::vector<EndlessWalk> walks;
      for (uint64_t seed = 0; seed < 4; ++seed) walks.emplace_back(phase, 30, seed);
      double z = 0, z2 = 0, r2 = 0, r4 = 0, turned = 0, first = 0;
      for (int n = 0; n < kPassages; ++n) {
        for (int i = 0; i < 40; ++i)
          for (EndlessWalk& walk : walks) walk.step();
        const EndlessWalk::Passage p = join_passages(walks, k);
        const auto along = static_cast<double>(dot(p.displacement, p.axis));
        const auto square = static_cast<double>(length_squared(p.displacement));
        z += along;
        z2 += along * along;
        r2 += square;
        r4 += square * square;
        turned += static_cast<double>(dot(p.last_direction, p.axis));
        first += static_cast<double>(dot(p.ray, p.axis));
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

TEST(EndlessWalk, WrongWalksAreFound) {
  EXPECT_GT(worst_deviation(HenyeyGreensteinPhase(0.72f), 0.7, 20, false), 2 * kLevel);
  // The start of the other closed form.
  const Moments m = measure(HenyeyGreensteinPhase(0.7f), 5, false);
  EXPECT_GT(std::abs(m.z - mean_z(0.7, 5, true)) / m.z_error, 2 * kLevel);
}

}  // namespace
}  // namespace turbid
