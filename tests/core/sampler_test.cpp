#include "core/sampler.h"

#include <gtest/gtest.h>

#include <array>
#include <set>

namespace turbid {
namespace {

TEST(Rng, SameCounterSameStreamAndNeighboursDiffer) {
  Rng a(17), b(17), c(18);
  std::set<uint32_t> seen;
  for (int i = 0; i < 100; ++i) {
    const uint32_t value = a.next_u32();
    EXPECT_EQ(value, b.next_u32());
    seen.insert(value);
    seen.insert(c.next_u32());
  }
  EXPECT_GT(seen.size(), 195u);
}

TEST(Rng, FloatsStayBelowOneAndAreUniform) {
  double sum = 0, squares = 0;
  constexpr int n = 200000;
  // The first number of many streams: as a renderer uses them, one stream per sample.
  for (uint64_t i = 0; i < n; ++i) {
    const double u = static_cast<double>(Rng(hash_counters(1, i, 2)).next_float());
    ASSERT_GE(u, 0);
    ASSERT_LT(u, 1);
    sum += u;
    squares += u * u;
  }
  EXPECT_NEAR(sum / n, 0.5, 4 * std::sqrt(1.0 / 12 / n));
  EXPECT_NEAR(squares / n, 1.0 / 3, 4 * std::sqrt(4.0 / 45 / n));
}

TEST(Sampler, ReplaysASampleByItsName) {
  for (const SamplerKind kind : {SamplerKind::kIndependent, SamplerKind::kSobol}) {
    Sampler forward(kind, 5), direct(kind, 5);
    for (uint64_t i = 0; i < 10; ++i) forward.start(3, i), forward.next_2d();
    forward.start(3, 4);
    direct.start(3, 4);
    for (int d = 0; d < 200; ++d) EXPECT_EQ(forward.next_1d(), direct.next_1d());
  }
}

TEST(Sampler, AsideDependsOnPurposePlaceAndDirectionAlone) {
  Sampler sampler(SamplerKind::kIndependent, 5), other(SamplerKind::kIndependent, 5);
  sampler.start(3, 4);
  other.start(3, 4);
  other.next_2d();
  const Vec3 place(1, 2, 3), direction(0, 0.6f, 0.8f);
  std::set<uint32_t> seen;
  for (const Purpose purpose : {Purpose::kAttenuation, Purpose::kAperture, Purpose::kLightsOfPlace})
    for (const Vec3& p : {place, -place})
      for (const Vec3& d : {direction, -direction, Vec3(0)}) {
        Rng rng = sampler.aside(purpose, p, d), again = other.aside(purpose, p, d);
        for (int i = 0; i < 10; ++i) {
          const uint32_t value = rng.next_u32();
          EXPECT_EQ(value, again.next_u32());
          seen.insert(value);
        }
      }
  EXPECT_EQ(seen.size(), 180u);
}

/// Counts how many cells of an nx x ny grid hold exactly one of nx * ny points.
template <class Point>
size_t cells_hit(size_t nx, size_t ny, const Point& point) {
  std::set<size_t> cells;
  for (size_t i = 0; i < nx * ny; ++i) {
    const Vec2 p = point(i);
    cells.insert(static_cast<size_t>(p.x * static_cast<float>(nx)) +
                 nx * static_cast<size_t>(p.y * static_cast<float>(ny)));
  }
  return cells.size();
}

TEST(Sampler, SobolPointsAreAZeroTwoSequenceInEveryPairOfDimensions) {
  // 64 points: one in each elementary interval of area 1/64, whatever its shape, for any pixel and any pair.
  for (int skip : {0, 2, 10, 40}) {
    for (const auto& [nx, ny] : {std::pair<size_t, size_t>{64, 1}, {1, 64}, {8, 8}, {16, 4}, {2, 32}}) {
      Sampler sampler(SamplerKind::kSobol, 99);
      const auto point = [&](size_t i) {
        sampler.start(12345, i);
        for (int d = 0; d < skip; d += 2) sampler.next_2d();
        return sampler.next_2d();
      };
      EXPECT_EQ(cells_hit(nx, ny, point), 64u) << nx << " x " << ny << " after " << skip;
    }
  }
}

TEST(Sampler, IndependentPointsAreNotStratified) {
  Sampler sampler(SamplerKind::kIndependent, 99);
  const auto point = [&](size_t i) {
    sampler.start(12345, i);
    return sampler.next_2d();
  };
  EXPECT_LT(cells_hit(8, 8, point), 60u);
}

TEST(Sampler, SobolDimensionsAreUncorrelated) {
  double product = 0;
  constexpr int n = 4096;
  Sampler sampler(SamplerKind::kSobol, 7);
  for (uint64_t i = 0; i < n; ++i) {
    sampler.start(1, i);
    const float a = sampler.next_1d(), b = sampler.next_1d();
    product += static_cast<double>((a - 0.5f) * (b - 0.5f));
  }
  EXPECT_NEAR(product / n, 0, 4 / 12.0 / std::sqrt(n));
}

}  // namespace
}  // namespace turbid
