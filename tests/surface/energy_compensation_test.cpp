// What rough surfaces lose, and what the compensating lobe gives back.
#include "surface/energy_compensation.h"

#include "core/gauss_legendre.h"
#include "core/warp.h"
#include "surface/bsdf_checks.h"
#include "surface/materials.h"

namespace turbid::testing {
namespace {

/// Every direction in gives all energy back, for both distributions and on both sides.
TEST(EnergyCompensation, LosesNothingInAnyDirection) {
  for (const MicrofacetType type : {MicrofacetType::kGgx, MicrofacetType::kBeckmann}) {
    for (const float alpha : {0.01f, 0.1f, 0.5f}) {
      for (const float index : {1.5f, 0.75f, 2.4f}) {
        const RoughDielectric glass(index, 1, roughness(type, alpha), nullptr, nullptr, true);
        for (const Vec3& given : given_directions()) {
          const Estimate energy = sampled_energy(glass, given, 10'000);
          EXPECT_NEAR(energy.mean, 1, 2e-3 + 4 * energy.error)
              << alpha << ", index " << index << ", cosine " << given.z;
        }
      }
      const RoughConductor mirror(nullptr, nullptr, roughness(type, alpha), nullptr, true);
      for (const double cosine : {1.0, 0.7, 0.2}) {
        const Estimate energy = sampled_energy(mirror, direction(cosine), 10'000);
        EXPECT_NEAR(energy.mean, 1, 2e-3 + 4 * energy.error) << alpha << ", cosine " << cosine;
      }
    }
  }
}

TEST(EnergyCompensation, MeansAreTheIntegralsOfTheTables) {
  const EnergyTable table(MicrofacetType::kGgx, 0.3f, 1.5f);
  const GaussLegendre rule(200);
  for (const int side : {0, 1}) {
    double mean = 0;
    for (size_t i = 0; i < rule.size(); ++i)
      mean += rule.weight(i) * 2 * rule.node(i) * double(table.missing(side, static_cast<float>(rule.node(i))));
    EXPECT_NEAR(table.mean(side), mean, 1e-4 * mean);
  }
}

/// Metals and coloured glass stay below what they reflect without loss.
TEST(EnergyCompensation, KeepsColoursPhysical) {
  const TexturePtr eta = constant(0.143f, 0.375f, 1.442f), k = constant(3.983f, 2.386f, 1.603f);
  for (const float alpha : {0.1f, 0.5f, 1.0f}) {
    const RoughConductor lossy(eta, k, roughness(MicrofacetType::kGgx, alpha));
    const RoughConductor whole(eta, k, roughness(MicrofacetType::kGgx, alpha), nullptr, true);
    const double before = integrated_energy(lossy, direction(0.6)), after = integrated_energy(whole, direction(0.6));
    EXPECT_GT(after, before);
    EXPECT_LT(after, 0.9);
  }
}

/// Roughness from a texture interpolates between tables.
TEST(EnergyCompensation, HoldsForTexturedRoughness) {
  class Varying final : public Texture {
   public:
    Spectrum eval(const SurfacePoint&) const override { return Spectrum(0.37f); }
    float eval_scalar(const SurfacePoint&) const override { return 0.37f; }
    Spectrum mean() const override { return Spectrum(0.37f); }
    float max() const override { return 0.37f; }
  };
  const Roughness textured{MicrofacetType::kGgx, std::make_shared<Varying>(), nullptr, true};
  const RoughDielectric glass(1.5f, 1, textured, nullptr, nullptr, true);
  for (const Vec3& given : given_directions()) {
    const Estimate energy = sampled_energy(glass, given);
    EXPECT_NEAR(energy.mean, 1, 5e-3 + 4 * energy.error) << given.z;
  }
  expect_reciprocal(glass, 1.5f, "textured", 1e-2);
}

/// A sphere of radius 1 with a medium of albedo 1 and sigma_s = 5 (isotropic), radiance 1 all around: what an
/// orthographic camera sees of it on average, walking in radiance mode.
Estimate furnace(const Bsdf& boundary, int paths) {
  const SurfacePoint point;
  Rng rng(17);
  double sum = 0, sum2 = 0;
  for (int path = 0; path < paths; ++path) {
    Vec3 given = direction(std::sqrt(rng.next_double()), 0);  // towards the camera: outside
    Vec3 normal(0, 0, 1);
    double throughput = 1;
    for (int step = 0; step < 100'000; ++step) {
      const Frame frame(normal);
      const Numbers n(rng);
      const auto sample = boundary.sample(point, given, n.lobe, n.u, TransportMode::kRadiance);
      if (!sample) {
        throughput = 0;
        break;
      }
      throughput *= double(sample->weight.mean());
      if (sample->direction.z > 0) break;  // escapes and sees radiance 1
      // Through the medium until the boundary is met again.
      Vec3 p = normal, d = frame.to_world(sample->direction);
      while (true) {
        const double b = double(dot(p, d)), c = double(dot(p, p)) - 1;
        const double exit = -b + std::sqrt(std::max(0.0, b * b - c));
        const double flight = -std::log(1 - rng.next_double()) / 5;
        if (flight >= exit) {
          p += d * static_cast<float>(exit);
          break;
        }
        p += d * static_cast<float>(flight);
        const Numbers scatter(rng);
        d = square_to_sphere(scatter.u);
      }
      normal = normalize(p);
      given = Frame(normal).to_local(-d);
      if (given.z >= 0) given.z = -1e-6f;
      given = normalize(given);
    }
    sum += throughput;
    sum2 += throughput * throughput;
  }
  const double mean = sum / paths;
  return {mean, std::sqrt(std::max(0.0, sum2 / paths - mean * mean) / paths)};
}

TEST(EnergyCompensation, WhiteFurnaceIsWhite) {
  for (const float alpha : {0.01f, 0.05f, 0.1f, 0.2f, 0.5f}) {
    const RoughDielectric glass(1.5f, 1, roughness(MicrofacetType::kGgx, alpha), nullptr, nullptr, true);
    const Estimate radiance = furnace(glass, alpha < 0.3f ? 60'000 : 200'000);
    EXPECT_NEAR(radiance.mean, 1, 5e-3) << "alpha " << alpha << ", standard error " << radiance.error;
    EXPECT_LT(radiance.error, 2e-3);
  }
}

/// Without compensation: the values of an independent simulation of single-scattering GGX facets (NUMERICS 9).
TEST(EnergyCompensation, WithoutItTheFurnaceDarkensAsKnown) {
  const std::pair<float, double> known[] = {{0.01f, 0.9985}, {0.05f, 0.975}, {0.1f, 0.922}, {0.2f, 0.80}, {0.5f, 0.52}};
  for (const auto& [alpha, value] : known) {
    const RoughDielectric glass(1.5f, 1, roughness(MicrofacetType::kGgx, alpha));
    const Estimate radiance = furnace(glass, 20'000);
    EXPECT_NEAR(radiance.mean, value, 0.006 + 4 * radiance.error) << "alpha " << alpha;
    EXPECT_LT(radiance.mean, 1 + 4 * radiance.error);
  }
}

TEST(GaussLegendre, IntegratesPolynomialsExactly) {
  for (const size_t n : {1u, 2u, 3u, 8u, 40u}) {
    const GaussLegendre rule(n);
    const double power = 2.0 * double(n) - 1;
    double sum = 0;
    for (size_t i = 0; i < n; ++i) sum += rule.weight(i) * std::pow(rule.node(i), power);
    EXPECT_NEAR(sum, 1 / (power + 1), 1e-13) << n;
  }
}

}  // namespace
}  // namespace turbid::testing
