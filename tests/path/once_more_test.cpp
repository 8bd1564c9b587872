// Once-more scattered connections against quadrature and against their own density.
#include "path/once_more.h"

#include <gtest/gtest.h>

#include "core/rng.h"
#include "core/warp.h"
#include "medium/angle_distribution.h"
#include "medium/half_henyey_greenstein.h"
#include "medium/henyey_greenstein.h"
#include "medium/isotropic.h"

namespace turbid {
namespace {

struct Moments {
  double mean, deviation, error;  ///< deviation: of one sample
};

template <class Sample>
Moments moments(int n, const Sample& sample) {
  double sum = 0, squares = 0;
  for (int i = 0; i < n; ++i) {
    const double value = sample();
    sum += value;
    squares += value * value;
  }
  const double mean = sum / n, variance = std::max(0.0, squares / n - mean * mean);
  return {mean, std::sqrt(variance), std::sqrt(variance / n)};
}

const Vec3 kFrom{0.3f, -0.2f, 0.1f}, kTo{1.1f, 0.4f, 0.1f};  // 1 apart

std::optional<InsertedCollision> draw(const PhaseFunction& phase, Rng& rng, Insertion insertion,
                                      const Vec3& from = kFrom, const Vec3& to = kTo) {
  const float u_theta = rng.next_float(), u_beta = rng.next_float();
  return insert_collision(phase, from, PathEnd{to}, insertion, u_theta, u_beta, rng.next_float());
}

/// f / (d1^2 d2^2) exp(-sigma (d1 + d2)) over the density.
Moments connect(const PhaseFunction& phase, Insertion insertion, double sigma, int n = 200000) {
  Rng rng(7);
  return moments(n, [&] {
    const auto x1 = draw(phase, rng, insertion);
    if (!x1) return 0.0;
    const double d1 = static_cast<double>(x1->d1), d2 = static_cast<double>(x1->d2);
    return static_cast<double>(x1->f) / (d1 * d1 * d2 * d2) * std::exp(-sigma * (d1 + d2)) / x1->pdf_v;
  });
}

// NUMERICS 2.2: 2 pi Z / s, whatever is drawn, but for rounding and for the table.
TEST(OnceMore, HasNoVarianceInClearSpace) {
  const auto expect = [](const PhaseFunction& phase, double expected) {
    const Moments m = connect(phase, Insertion::kAngle, 0);
    EXPECT_NEAR(m.mean / expected, 1, 2e-5);
    EXPECT_LT(m.deviation, 2e-5 * expected);
    EXPECT_NEAR(2 * std::numbers::pi * phase.angles().moment() / expected, 1, 1e-5);
  };
  expect(IsotropicPhase(), std::numbers::pi * std::numbers::pi / 4);
  expect(HenyeyGreensteinPhase(0.9f), 1.07475);
  expect(HenyeyGreensteinPhase(0.98f), 1.01431);
}

TEST(OnceMore, HasTheDeviationsThatQuadratureGives) {
  const Moments g90 = connect(HenyeyGreensteinPhase(0.9f), Insertion::kAngle, 0.5);
  const Moments g98 = connect(HenyeyGreensteinPhase(0.98f), Insertion::kAngle, 0.5);
  EXPECT_NEAR(g90.deviation / g90.mean, 0.139, 0.0015);
  EXPECT_NEAR(g98.deviation / g98.mean, 0.061, 0.0015);
}

TEST(OnceMore, AsPublishedAgreesOnForwardPhaseFunctions) {
  const HalfHenyeyGreensteinPhase forward(0.9f, HalfHenyeyGreensteinPhase::Hemisphere::kForward);
  for (const double sigma : {0.0, 0.5}) {
    const Moments angle = connect(forward, Insertion::kAngle, sigma);
    const Moments published = connect(forward, Insertion::kSolidAngle, sigma);
    EXPECT_LT(std::abs(angle.mean - published.mean), 3.5 * std::hypot(angle.error, published.error) + 2e-5);
    EXPECT_LT(angle.deviation, published.deviation);
  }
}

/// The integral of a smooth blob over space, by drawn collisions and uniformly in a box: the density is that of the
/// samples. `scale` other than 1 is a planted error.
template <class Draw>
void expect_density_of(const Draw& draw_one, const Vec3& center, double share = 1, double scale = 1) {
  Rng rng(3);
  const auto blob = [&](const Vec3& x) {
    return std::exp(-static_cast<double>(length_squared(x - center)) / (2 * 0.15 * 0.15));
  };
  const double expected = share * std::pow(2 * std::numbers::pi * 0.15 * 0.15, 1.5);
  const Moments m = moments(400000, [&] {
    const std::optional<InsertedCollision> x1 = draw_one(rng);
    return x1 ? blob(x1->position) / (scale * x1->pdf_v) : 0.0;
  });
  if (scale == 1)
    EXPECT_LT(std::abs(m.mean - expected), 4 * m.error) << m.mean << " against " << expected;
  else
    EXPECT_GT(std::abs(m.mean - expected), 4 * m.error);
}

void expect_density(const PhaseFunction& phase, Insertion insertion, const Vec3& center, double scale = 1) {
  expect_density_of([&](Rng& rng) { return draw(phase, rng, insertion); }, center, 1, scale);
}

TEST(OnceMore, DensityIsThatOfTheSamples) {
  const Vec3 between{0.75f, 0.25f, 0.15f}, behind{-0.1f, -0.4f, 0.3f};
  expect_density(IsotropicPhase(), Insertion::kAngle, between);
  expect_density(IsotropicPhase(), Insertion::kAngle, behind);
  expect_density(HenyeyGreensteinPhase(0.6f), Insertion::kAngle, between);
  expect_density(HenyeyGreensteinPhase(-0.3f), Insertion::kAngle, behind);
  expect_density(IsotropicPhase(), Insertion::kGeometry, behind);
  expect_density(HenyeyGreensteinPhase(0.6f), Insertion::kAngle, between, 1.05);
}

std::optional<InsertedCollision> draw_in(const Cone& cone, const PhaseFunction& phase, Rng& rng) {
  const float u_theta = rng.next_float(), u_gamma = rng.next_float();
  return insert_collision(phase, kFrom, PathEnd{kTo, false, cone}, Insertion::kAngle, u_theta, u_gamma,
                          rng.next_float());
}

// The blob is cut in halves by a plane through the other end, which is the border of a cone of 90 degrees; and it lies
// inside a narrower one, whose weight is smaller.
TEST(OnceMore, CanBeConfinedToACone) {
  const HenyeyGreensteinPhase phase(0.4f);
  const Vec3 beside = kTo + Vec3(0.1f, 0.3f, -0.2f), towards = normalize(beside - kTo);
  const Vec3 across = normalize(cross(towards, Vec3(0.2f, 0.3f, 1)));
  expect_density_of([&](Rng& rng) { return draw_in({across, std::numbers::pi / 2}, phase, rng); }, beside, 0.5);
  expect_density_of([&](Rng& rng) { return draw_in({-across, std::numbers::pi / 2}, phase, rng); }, beside, 0.5);
  const Vec3 far = kTo + Vec3(0.4f, 1.2f, -0.8f);
  const Cone narrow{normalize(towards + across * 0.1f), 0.9};
  expect_density_of([&](Rng& rng) { return draw_in(narrow, phase, rng); }, far);
  Rng rng(9);
  for (int i = 0; i < 10000; ++i) {
    const auto x1 = draw_in(narrow, phase, rng);
    ASSERT_TRUE(x1);
    EXPECT_LT(angle_between(x1->position - kTo, narrow.axis), 0.9001);
    const double again = insertion_pdf_v(phase, kFrom, x1->position, {kTo, false, narrow}, Insertion::kAngle);
    if (x1->theta > 0.05f && x1->theta < 3.1f && std::min(x1->d1, x1->d2) > 0.05f && again > 0) {
      EXPECT_NEAR(again / x1->pdf_v, 1, 2e-3);
    }
  }
}

TEST(OnceMore, TowardsInfinityDensityIsThatOfTheSamples) {
  const HenyeyGreensteinPhase phase(0.5f);
  const Spectrum sigma_t(0.5f, 1, 3);
  for (const Insertion insertion : {Insertion::kAngle, Insertion::kGeometry})
    expect_density_of(
        [&](Rng& rng) {
          const float u_theta = rng.next_float(), u_phi = rng.next_float();
          return insert_collision_towards(phase, sigma_t, kFrom, normalize(Vec3(1, 2, 3)), insertion, u_theta, u_phi,
                                          rng.next_float());
        },
        kFrom + Vec3(0.3f, 0.4f, 0.4f));
}

TEST(OnceMore, DensityOfAGivenCollisionIsTheSame) {
  Rng rng(5);
  for (const float g : {0.0f, 0.5f, 0.9f, -0.7f}) {
    const HenyeyGreensteinPhase phase(g);
    for (const Insertion insertion : {Insertion::kAngle, Insertion::kSolidAngle})
      for (int i = 0; i < 2000; ++i) {
        const auto x1 = draw(phase, rng, insertion);
        // Positions are rounded: a flat triangle does not remember its angle, nor a point close to an end its distance.
        if (!x1 || x1->theta < 0.02f || x1->theta > 3.12f || std::min(x1->d1, x1->d2) < 0.01f) continue;
        EXPECT_NEAR(insertion_pdf_v(phase, kFrom, x1->position, PathEnd{kTo}, insertion) / x1->pdf_v, 1, 2e-3);
        EXPECT_NEAR(length(x1->position - kFrom), x1->d1, 1e-5f * (1 + x1->d1));
        EXPECT_NEAR(length(kTo - x1->position), x1->d2, 1e-5f * (1 + x1->d2));
        EXPECT_LT(length(x1->arrives - normalize(x1->position - kFrom)), 1e-3f);
        EXPECT_LT(length(x1->leaves - normalize(kTo - x1->position)), 1e-3f);
        EXPECT_NEAR(std::acos(std::clamp(dot(x1->arrives, x1->leaves), -1.0f, 1.0f)), x1->theta, 2e-3f);
      }
  }
}

TEST(OnceMore, DegenerateInputIsFiniteOrNothing) {
  const IsotropicPhase isotropic;
  EXPECT_FALSE(insert_collision(isotropic, kFrom, PathEnd{kFrom}, Insertion::kAngle, 0.5f, 0.5f, 0.5f));
  EXPECT_EQ(insertion_pdf_v(isotropic, kFrom, kFrom, PathEnd{kTo}, Insertion::kAngle), 0);
  EXPECT_EQ(insertion_pdf_v(isotropic, kFrom, kTo, PathEnd{kTo}, Insertion::kAngle), 0);
  Rng rng(11);
  const HenyeyGreensteinPhase sharp(0.999f), back(-0.999f), soft(0.3f);
  const auto number = [&] { return std::ldexp(2 * rng.next_float() - 1, static_cast<int>(rng.next_u32() % 40) - 20); };
  const auto unit = [&] {
    const uint32_t kind = rng.next_u32() % 8;
    return kind == 0 ? 0.0f : kind == 1 ? kOneMinusEpsilon : rng.next_float();
  };
  for (int i = 0; i < 1000000; ++i) {
    const PhaseFunction& phase = i % 3 == 0   ? static_cast<const PhaseFunction&>(sharp)
                                 : i % 3 == 1 ? static_cast<const PhaseFunction&>(back)
                                              : soft;
    const Vec3 from(number(), number(), number()), to = i % 5 == 0 ? from : Vec3(number(), number(), number());
    const Insertion insertion = i % 2 == 0 ? Insertion::kAngle : Insertion::kSolidAngle;
    const float u_theta = unit(), u_beta = unit();
    const auto x1 = insert_collision(phase, from, PathEnd{to}, insertion, u_theta, u_beta, unit());
    if (!x1) continue;
    ASSERT_TRUE(std::isfinite(x1->pdf_v) && x1->pdf_v > 0);
    ASSERT_TRUE(std::isfinite(x1->f) && x1->f >= 0);
    ASSERT_TRUE(std::isfinite(length(x1->position)));
    ASSERT_NEAR(length(x1->arrives), 1, 1e-4f);
    ASSERT_NEAR(length(x1->leaves), 1, 1e-4f);
    const double again = insertion_pdf_v(phase, from, x1->position, PathEnd{to}, insertion);
    ASSERT_TRUE(std::isfinite(again) && again >= 0);
  }
}

}  // namespace
}  // namespace turbid
