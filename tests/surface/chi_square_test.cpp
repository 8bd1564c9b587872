// The chi-square harness itself: it accepts right samplers and refuses planted errors.
#include "testing/chi_square.h"

#include <gtest/gtest.h>

#include "core/frame.h"
#include "core/warp.h"

namespace turbid::testing {
namespace {

Vec2 two(Rng& rng) {
  const float x = rng.next_float();
  return {x, rng.next_float()};
}
std::optional<Vec3> cosine(Rng& rng) { return square_to_cosine_hemisphere(two(rng)); }
double cosine_pdf(const Vec3& v) { return cosine_hemisphere_pdf_w(v); }

/// A cone of half-angle 0.6 degrees about a slanted axis: a peak far narrower than a cell.
std::optional<Vec3> narrow(Rng& rng) {
  return Frame(normalize(Vec3(1, 2, 1))).to_world(square_to_cone(two(rng), 0.99995f));
}
double narrow_pdf(const Vec3& v) {
  return dot(v, normalize(Vec3(1, 2, 1))) > 0.99995f ? double(cone_pdf_w(0.99995f)) : 0.0;
}

TEST(ChiSquare, AcceptsRightSamplers) {
  const auto uniform = [](Rng& rng) -> std::optional<Vec3> { return square_to_sphere(two(rng)); };
  const ChiSquareResult results[] = {
      chi_square_sphere(uniform, [](const Vec3&) { return double(kUniformSpherePdfW); }),
      chi_square_sphere(cosine, cosine_pdf),
      chi_square_interval([](Rng& rng) -> std::optional<double> { return std::sqrt(rng.next_double()); },
                          [](double x) { return 2 * x; }, 0, 1),
      chi_square_square(
          [](Rng& rng) -> std::optional<Vec2> { return Vec2(std::sqrt(rng.next_float()), rng.next_float()); },
          [](const Vec2& p) { return 2.0 * double(p.x); })};
  for (const ChiSquareResult& result : results) EXPECT_TRUE(passes(result, 4)) << result.report;
}

TEST(ChiSquare, FindsMassInNarrowPeaks) {
  const ChiSquareResult result = chi_square_sphere(narrow, narrow_pdf);
  EXPECT_NEAR(result.mass, 1, 5e-3) << result.report;
}

TEST(ChiSquare, CountsFailedSamplesAsMissingMass) {
  const auto half = [](Rng& rng) -> std::optional<Vec3> {
    const Vec3 v = square_to_sphere(two(rng));
    return v.z > 0 ? std::optional(v) : std::nullopt;
  };
  const auto right = [](const Vec3& v) { return v.z > 0 ? double(kUniformSpherePdfW) : 0.0; };
  const ChiSquareResult accepted = chi_square_sphere(half, right);
  EXPECT_TRUE(passes(accepted)) << accepted.report;
  // Planted: the density claims that no sample fails.
  const ChiSquareResult refused = chi_square_sphere(half, [&](const Vec3& v) { return 2 * right(v); });
  EXPECT_FALSE(passes(refused)) << refused.report;
}

TEST(ChiSquare, RefusesPlantedErrors) {
  const auto uniform_pdf = [](const Vec3& v) { return v.z > 0 ? 2.0 * double(kUniformSpherePdfW) : 0.0; };
  EXPECT_FALSE(passes(chi_square_sphere(cosine, uniform_pdf), 1000)) << "wrong formula";
  EXPECT_FALSE(passes(chi_square_sphere(cosine, [](const Vec3& v) { return 1.02 * cosine_pdf(v); }), 1000))
      << "too large";
  EXPECT_FALSE(passes(chi_square_sphere(cosine, [](const Vec3& v) { return 0.98 * cosine_pdf(v); }), 1000))
      << "too small";
  EXPECT_FALSE(passes(chi_square_sphere(cosine, [](const Vec3& v) { return cosine_pdf(-v); }), 1000)) << "wrong side";
  EXPECT_FALSE(passes(chi_square_interval([](Rng& rng) -> std::optional<double> { return rng.next_double(); },
                                          [](double x) { return 0.95 + 0.1 * x; }, 0, 1),
                      1000))
      << "five per cent slope";
  EXPECT_FALSE(passes(chi_square_square([](Rng& rng) -> std::optional<Vec2> { return two(rng) * 1.01f; },
                                        [](const Vec2&) { return 1.0; }),
                      1000))
      << "outside";
  EXPECT_FALSE(passes(chi_square_sphere(cosine, [](const Vec3&) { return std::nan(""); }))) << "not a number";
}

TEST(ChiSquare, HasTheLevelThatItClaims) {
  // p-values of a right sampler are uniform: of 400 tests with other seeds about 1 % fail at level 0.01.
  int failures = 0;
  for (uint64_t seed = 0; seed < 400; ++seed) {
    ChiSquareSettings settings;
    settings.seed = seed;
    settings.samples = 5000;
    settings.interval_bins = 20;
    failures += !passes(chi_square_interval([](Rng& rng) -> std::optional<double> { return rng.next_double(); },
                                            [](double) { return 1.0; }, 0, 1, settings));
  }
  EXPECT_LE(failures, 13);  // binomial(400, 0.01) exceeds 13 with probability 1e-4
}

TEST(ChiSquare, SidakLevel) {
  ChiSquareResult result;
  result.p_value = 0.009;
  EXPECT_FALSE(passes(result, 1));
  EXPECT_TRUE(passes(result, 2));
  result.p_value = 1e-4;
  EXPECT_FALSE(passes(result, 100));
  EXPECT_TRUE(passes(result, 101));
}

}  // namespace
}  // namespace turbid::testing
