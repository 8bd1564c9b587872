#pragma once
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "core/rng.h"
#include "surface/bsdf.h"
#include "testing/chi_square.h"

/// What every BSDF must satisfy, whatever it models.
namespace turbid::testing {

inline Vec3 direction(double cosine, double phi = 0.7) {
  const double sine = std::sqrt(1 - cosine * cosine);
  return Vec3(static_cast<float>(sine * std::cos(phi)), static_cast<float>(sine * std::sin(phi)),
              static_cast<float>(cosine));
}

struct Numbers {
  float lobe;
  Vec2 u;
  explicit Numbers(Rng& rng) : lobe(rng.next_float()) {
    u.x = rng.next_float();
    u.y = rng.next_float();
  }
};

/// Directions from both sides, from the normal to almost grazing.
inline std::vector<Vec3> given_directions() {
  std::vector<Vec3> result;
  for (const double cosine : {1.0, 0.8, 0.3, 0.05})
    for (const double sign : {1.0, -1.0}) result.push_back(direction(sign * cosine));
  return result;
}

/// Chi-square of the smooth lobes: delta samples are missing mass. `pdf_factor` plants an error.
inline ChiSquareResult chi_square_bsdf(const Bsdf& bsdf, const Vec3& given, TransportMode mode, double pdf_factor = 1) {
  const SurfacePoint point;
  ChiSquareSettings settings;
  settings.theta_bins = 12;
  settings.phi_bins = 24;
  settings.samples = 40'000;
  return chi_square_sphere(
      [&](Rng& rng) -> std::optional<Vec3> {
        const Numbers n(rng);
        const auto sample = bsdf.sample(point, given, n.lobe, n.u, mode);
        if (!sample || (sample->flags & lobe::kDelta)) return std::nullopt;
        return sample->direction;
      },
      [&](const Vec3& chosen) { return pdf_factor * double(bsdf.eval(point, given, chosen, mode).pdf_w); }, settings);
}

/// Samples follow the density, for all directions and both modes; nothing is sampled where the density says so.
inline void expect_right_sampler(const Bsdf& bsdf, const std::string& name) {
  const std::vector<Vec3> directions = given_directions();
  const int tests = static_cast<int>(directions.size());
  for (size_t i = 0; i < directions.size(); ++i) {
    // Densities do not depend on the mode (checked below), so one of them is enough here.
    const TransportMode mode = i % 2 ? TransportMode::kRadiance : TransportMode::kImportance;
    const ChiSquareResult result = chi_square_bsdf(bsdf, directions[i], mode);
    EXPECT_TRUE(passes(result, 40 * tests)) << name << ", cosine " << directions[i].z << ": " << result.report;
  }
}

/// weight = value / pdf at the samples, flags and eta are coherent, everything is finite. `same_in_both_modes`: but for
/// the factor of refraction, the modes have the same values and densities (tilted materials do not).
inline void expect_coherent_samples(const Bsdf& bsdf, const std::string& name, double tolerance = 1e-3,
                                    bool same_in_both_modes = true) {
  const SurfacePoint point;
  Rng rng(7);
  std::vector<Vec3> directions = given_directions();
  for (const double cosine : {1e-3, 1e-6, 0.0}) {
    directions.push_back(direction(cosine));
    directions.push_back(direction(-cosine));
  }
  for (const Vec3& given : directions) {
    for (int i = 0; i < 400; ++i) {
      const Numbers n(rng);
      for (const TransportMode mode : {TransportMode::kRadiance, TransportMode::kImportance}) {
        const auto sample = bsdf.sample(point, given, n.lobe, n.u, mode);
        if (!sample) continue;
        const std::string where = name + ", given cosine " + std::to_string(given.z) + ", chosen cosine " +
                                  std::to_string(sample->direction.z);
        ASSERT_TRUE(sample->weight.is_finite() && sample->weight.min() >= 0) << where;
        ASSERT_NEAR(length(sample->direction), 1, 1e-4f) << where;
        ASSERT_TRUE((sample->flags & bsdf.flags()) == sample->flags) << where;
        const bool stays = sample->direction.z * given.z > 0;
        if (given.z != 0) {
          ASSERT_EQ(stays, (sample->flags & lobe::kReflection) != 0) << where;
          ASSERT_EQ(!stays, (sample->flags & lobe::kTransmission) != 0) << where;
        }
        if (stays || (sample->flags & lobe::kNull)) {
          ASSERT_EQ(sample->eta, 1) << where;
        }
        if (sample->flags & lobe::kDelta) {
          ASSERT_EQ(sample->pdf_w, 0) << where;
          continue;
        }
        ASSERT_TRUE(sample->pdf_w > 0 && std::isfinite(sample->pdf_w)) << where;
        const Bsdf::Eval eval = bsdf.eval(point, given, sample->direction, mode);
        // A half vector made anew from rounded directions moves a sharp peak a little: compare ratios there.
        if (eval.pdf_w > 0) {
          ASSERT_NEAR(sample->weight.mean(), eval.value.mean() / eval.pdf_w,
                      static_cast<float>(tolerance) * std::max(1.0f, sample->weight.mean()))
              << where;
        }
        ASSERT_NEAR(sample->pdf_w, eval.pdf_w, static_cast<float>(20 * tolerance) * sample->pdf_w) << where;
        if (!same_in_both_modes) continue;
        const Bsdf::Eval other =
            bsdf.eval(point, given, sample->direction,
                      mode == TransportMode::kRadiance ? TransportMode::kImportance : TransportMode::kRadiance);
        ASSERT_EQ(other.pdf_w, eval.pdf_w) << where;
        ASSERT_NEAR(eval.value.mean() * (mode == TransportMode::kRadiance ? sqr(sample->eta) : 1 / sqr(sample->eta)),
                    other.value.mean(), 1e-4f * other.value.mean())
            << where;
      }
    }
  }
}

/// f(a, b) / eta_b^2 = f(b, a) / eta_a^2 in importance mode (reciprocity across an interface), and radiance from a to b
/// is importance from b to a. `eta` = inside / outside. Tilted materials are not `reciprocal`, but both modes still are
/// each other's adjoint.
inline void expect_reciprocal(const Bsdf& bsdf, float eta, const std::string& name, double tolerance = 2e-4,
                              bool reciprocal = true) {
  const SurfacePoint point;
  Rng rng(3);
  int compared = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vec3 a = direction(2 * rng.next_double() - 1, 6.2 * rng.next_double());
    Numbers n(rng);
    const auto sample = bsdf.sample(point, a, n.lobe, n.u, TransportMode::kImportance);
    if (!sample || !(sample->flags & lobe::kSmooth)) continue;
    const Vec3 b = sample->direction;
    const float n_a = a.z > 0 ? 1 : eta, n_b = b.z > 0 ? 1 : eta;
    if (std::abs(a.z) < 1e-3f || std::abs(b.z) < 1e-3f) continue;
    const auto f = [&](const Vec3& given, const Vec3& chosen, TransportMode mode) {
      return bsdf.eval(point, given, chosen, mode).value.mean() / std::abs(chosen.z);
    };
    const float forward = f(a, b, TransportMode::kImportance), backward = f(b, a, TransportMode::kImportance);
    if (reciprocal) {
      ASSERT_NEAR(forward / sqr(n_b), backward / sqr(n_a), tolerance * std::max(1e-3, double(forward / sqr(n_b))))
          << name;
    }
    const float radiance = f(b, a, TransportMode::kRadiance);
    ASSERT_NEAR(radiance, forward, tolerance * std::max(1e-3, double(forward))) << name;
    ++compared;
  }
  EXPECT_GT(compared, 200) << name;
}

/// Energy that leaves, in importance mode, estimated by samples: deltas included. The standard error comes with it.
struct Estimate {
  double mean, error;
};
inline Estimate sampled_energy(const Bsdf& bsdf, const Vec3& given, int samples = 20'000) {
  const SurfacePoint point;
  Rng rng(11);
  double sum = 0, sum2 = 0;
  for (int i = 0; i < samples; ++i) {
    const Numbers n(rng);
    const auto sample = bsdf.sample(point, given, n.lobe, n.u, TransportMode::kImportance);
    const double w = sample ? double(sample->weight.mean()) : 0;
    sum += w;
    sum2 += w * w;
  }
  const double mean = sum / samples;
  return {mean, std::sqrt(std::max(0.0, sum2 / samples - mean * mean) / samples)};
}

/// The same by quadrature over all directions: smooth lobes only.
inline double integrated_energy(const Bsdf& bsdf, const Vec3& given, double tolerance = 1e-4) {
  const SurfacePoint point;
  return integrate_sphere(
      [&](const Vec3& chosen) {
        return double(bsdf.eval(point, given, chosen, TransportMode::kImportance).value.mean());
      },
      tolerance);
}

/// Nothing creates energy, and quadrature agrees with sampling (for BSDFs without delta lobes).
inline void expect_energy_bounded(const Bsdf& bsdf, const std::string& name, double bound = 1.0005) {
  for (const Vec3& given : given_directions()) {
    const Estimate sampled = sampled_energy(bsdf, given);
    EXPECT_LE(sampled.mean, bound + 4 * sampled.error) << name << ", cosine " << given.z;
    if (bsdf.flags() & lobe::kDelta) continue;
    EXPECT_NEAR(integrated_energy(bsdf, given), sampled.mean, 4.5 * sampled.error + 1e-3)
        << name << ", cosine " << given.z;
  }
}

}  // namespace turbid::testing
