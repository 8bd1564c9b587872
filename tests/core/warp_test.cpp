#include "core/warp.h"

#include <gtest/gtest.h>

#include "testing/chi_square.h"

namespace turbid {
namespace {

using testing::chi_square_interval;
using testing::chi_square_sphere;
using testing::chi_square_square;
using testing::ChiSquareResult;
using testing::passes;

Vec2 next_2d(Rng& rng) {
  const float u = rng.next_float();
  return {u, rng.next_float()};
}

TEST(Warp, SamplesFollowTheirDensities) {
  constexpr int kTests = 5;
  const std::pair<const char*, ChiSquareResult> results[] = {
      {"sphere", chi_square_sphere([](Rng& rng) { return square_to_sphere(next_2d(rng)); },
                                   [](const Vec3&) { return static_cast<double>(kUniformSpherePdfW); })},
      {"cosine", chi_square_sphere([](Rng& rng) { return square_to_cosine_hemisphere(next_2d(rng)); },
                                   [](const Vec3& v) { return static_cast<double>(cosine_hemisphere_pdf_w(v)); })},
      {"cone",
       chi_square_sphere([](Rng& rng) { return square_to_cone(next_2d(rng), 0.5f); },
                         [](const Vec3& v) { return v.z >= 0.5f ? static_cast<double>(cone_pdf_w(0.5f)) : 0; })},
      {"tent", chi_square_interval([](Rng& rng) { return static_cast<double>(interval_to_tent(rng.next_float())); },
                                   [](double x) { return 1 - std::abs(x); }, -1, 1)},
      {"disk", chi_square_square(
                   [](Rng& rng) {  // in polar coordinates (r^2, phi) the uniform disk is uniform
                     const Vec2 p = square_to_disk(next_2d(rng));
                     const float phi = std::atan2(p.y, p.x) / (2 * kPi);
                     return Vec2(dot({p.x, p.y, 0}, {p.x, p.y, 0}), phi < 0 ? phi + 1 : phi);
                   },
                   [](const Vec2&) { return 1.0; })},
  };
  for (const auto& [name, result] : results) EXPECT_TRUE(passes(result, kTests)) << name << ": " << result.report;
}

TEST(Warp, TrianglePointsAreUniform) {
  Rng rng(4);
  Vec2 sum{0, 0};
  constexpr int n = 100000;
  for (int i = 0; i < n; ++i) {
    const Vec2 b = square_to_triangle(next_2d(rng));
    ASSERT_GE(b.x, 0);
    ASSERT_GE(b.y, 0);
    ASSERT_LE(b.x + b.y, 1 + 1e-6f);
    sum += b;
  }
  EXPECT_NEAR(sum.x / n, 1.0 / 3, 0.003);
  EXPECT_NEAR(sum.y / n, 1.0 / 3, 0.003);
}

// A cosine-weighted sampler that claims to be uniform must be caught.
TEST(Warp, HarnessNoticesAPlantedError) {
  const auto result = chi_square_sphere([](Rng& rng) { return square_to_cosine_hemisphere(next_2d(rng)); },
                                        [](const Vec3& v) { return v.z > 0 ? 0.5 / static_cast<double>(kPi) : 0; });
  EXPECT_FALSE(passes(result));
}

}  // namespace
}  // namespace turbid
