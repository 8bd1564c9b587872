// Deflections distributed as theta f(cos theta): for every phase function the table is that density, is sampled as it
// says, and has the moments that quadrature finds (NUMERICS 2.2).
#include "medium/angle_distribution.h"

#include <gtest/gtest.h>

#include <array>
#include <set>

#include "core/parallel.h"
#include "medium/half_henyey_greenstein.h"
#include "medium/henyey_greenstein.h"
#include "medium/isotropic.h"
#include "medium/phases_for_tests.h"

namespace turbid {
namespace {

using testing::all_phase_functions;
using testing::ChiSquareResult;
using testing::integrate_angles;

constexpr double kTwoPi = 2 * std::numbers::pi;

/// Samples against a density over theta, as t = theta^(1/4): a tenth of the histogram lies below half a milliradian.
ChiSquareResult test_angles(const AngleDistribution& sampled, const std::function<double(double)>& density) {
  return testing::chi_square_interval(
      [&](Rng& rng) -> std::optional<double> {
        return std::pow(static_cast<double>(sampled.sample(rng.next_float())), 0.25);
      },
      [&](double t) { return 4 * t * t * t * density(std::min(t * t * t * t, std::numbers::pi)); }, 0,
      std::pow(std::numbers::pi, 0.25));
}

/// theta f / Z, not from the table.
std::function<double(double)> wanted(const PhaseFunction& phase, double z) {
  return [&phase, z](double theta) {
    return theta * static_cast<double>(phase.eval_angle(static_cast<float>(theta))) / z;
  };
}

TEST(AngleDistribution, IsSampledAsItSays) {
  const auto& all = all_phase_functions();
  for (const auto& [name, phase, grows] : all) {
    const AngleDistribution& angles = phase->angles();
    const auto result =
        test_angles(angles, [&](double theta) { return static_cast<double>(angles.pdf(static_cast<float>(theta))); });
    EXPECT_TRUE(passes(result, static_cast<int>(all.size()))) << name << ": " << result.report;
    EXPECT_NEAR(result.mass, 1, 1e-4) << name;
  }
}

TEST(AngleDistribution, FollowsThePhaseFunction) {
  const auto& all = all_phase_functions();
  for (const auto& [name, phase, grows] : all) {
    const AngleDistribution& angles = phase->angles();
    const auto result = test_angles(angles, wanted(*phase, angles.moment()));
    EXPECT_TRUE(passes(result, static_cast<int>(all.size()))) << name << ": " << result.report;
  }
}

TEST(AngleDistribution, PlantedErrorsAreFound) {
  const HenyeyGreensteinPhase right(0.9f), wrong(0.905f);
  const AngleDistribution& angles = right.angles();
  EXPECT_FALSE(passes(test_angles(angles, wanted(wrong, wrong.angles().moment())), 100)) << "slightly wrong g";
  EXPECT_FALSE(passes(test_angles(angles, wanted(right, 1.02 * angles.moment())), 100)) << "wrong normalisation";
  const auto by_solid_angle = [&](double theta) {
    return kTwoPi * std::sin(theta) * static_cast<double>(right.eval_angle(static_cast<float>(theta)));
  };
  EXPECT_FALSE(passes(test_angles(angles, by_solid_angle), 100)) << "sin(theta) for theta";
}

TEST(AngleDistribution, HasTheMomentsOfQuadrature) {
  for (const auto& [name, phase, grows] : all_phase_functions()) {
    const double z = integrate_angles(*phase, [](double theta) { return theta; });
    const double tolerance = name.starts_with("hg -0.999") || name.starts_with("backward_hg 0.999") ? 1e-4 : 2e-5;
    EXPECT_NEAR(phase->angles().moment() / z, 1, tolerance) << name;
  }
}

TEST(AngleDistribution, HasTheMomentsOfClosedForms) {
  const auto total = [](const PhaseFunction& phase) { return kTwoPi * phase.angles().moment(); };
  EXPECT_NEAR(total(IsotropicPhase()), std::numbers::pi * std::numbers::pi / 4, 1e-6);
  EXPECT_NEAR(total(HenyeyGreensteinPhase(0.9f)), 1.07475, 1e-5);
  EXPECT_NEAR(total(HenyeyGreensteinPhase(0.98f)), 1.01431, 1e-5);
  // Isotropic in a hemisphere: f = 1 / (2 pi), int theta dtheta = pi^2 / 8 forward and 3 pi^2 / 8 backward.
  using Half = HalfHenyeyGreensteinPhase;
  EXPECT_NEAR(total(Half(0, Half::Hemisphere::kForward)), std::numbers::pi * std::numbers::pi / 8, 1e-6);
  EXPECT_NEAR(total(Half(0, Half::Hemisphere::kBackward)), 3 * std::numbers::pi * std::numbers::pi / 8, 1e-6);
}

TEST(AngleDistribution, MakesTheWeightConstant) {
  // theta f / pdf, over samples: its mean is Z, and hardly any sample is more than 1e-3 off.
  for (const auto& [name, phase, grows] : all_phase_functions()) {
    const AngleDistribution& angles = phase->angles();
    double sum = 0, worst = 0;
    int off = 0;
    constexpr int kSamples = 20000;
    for (int i = 0; i < kSamples; ++i) {
      const float theta = angles.sample((static_cast<float>(i) + 0.5f) / kSamples);
      const double weight = static_cast<double>(theta * phase->eval_angle(theta) / angles.pdf(theta)) / angles.moment();
      sum += weight;
      worst = std::max(worst, std::abs(weight - 1));
      off += std::abs(weight - 1) > 1e-3;
    }
    EXPECT_NEAR(sum / kSamples, 1, 1e-4) << name;
    // The glory of large spheres, all alike, is so narrow that the steps of x = (1 - mu) / 2 next to 1 show.
    EXPECT_LE(off, name.starts_with("mie 20") ? kSamples / 200 : kSamples / 1000) << name << ", worst " << worst;
  }
}

TEST(AngleDistribution, SamplesAreInsideAndPossible) {
  constexpr int kSamples = 1 << 20;
  for (const auto& [name, phase, grows] : all_phase_functions()) {
    const AngleDistribution& angles = phase->angles();
    int bad = 0;
    float last = 0;
    for (int i = 0; i < kSamples; ++i) {
      const float theta = angles.sample(static_cast<float>(i) / kSamples), pdf = angles.pdf(theta);
      bad += !(theta > 0 && theta < kPi && std::isfinite(pdf) && pdf > 0 && theta >= last);
      last = theta;
    }
    const float largest = angles.sample(kOneMinusEpsilon);
    EXPECT_TRUE(largest >= last && largest < kPi) << name;
    EXPECT_EQ(bad, 0) << name;
  }
}

TEST(AngleDistribution, OfAPeakHasItWhereItBelongs) {
  // The median of theta f for a narrow Henyey-Greenstein peak: int_0^m t (w^2 + t^2)^(-3/2) dt = (1/w) / 2 at
  // m = sqrt(3) w, w = (1 - g) / sqrt(g).
  for (const float g : {0.99f, 0.999f}) {
    const double width = (1 - static_cast<double>(g)) / std::sqrt(static_cast<double>(g));
    EXPECT_NEAR(static_cast<double>(HenyeyGreensteinPhase(g).angles().sample(0.5f)) / (std::sqrt(3) * width), 1, 0.01);
  }
}

TEST(AngleDistribution, IsMadeOnceByWhicheverThread) {
  const HenyeyGreensteinPhase phase(0.5f);
  std::array<const AngleDistribution*, 64> seen{};
  parallel_for(seen.size(), [&](size_t i) { seen[i] = &phase.angles(); });
  EXPECT_EQ(std::set(seen.begin(), seen.end()).size(), 1u);
}

class Broken final : public PhaseFunction {
 public:
  explicit Broken(float value) : value_(value) {}
  float eval(float) const override { return value_; }
  float sample(float) const override { return 0; }
  float mean_cosine() const override { return 0; }

 private:
  float value_;
};

TEST(AngleDistribution, RefusesWhatIsNoDensity) {
  for (const float value : {-1.0f, 0.0f, std::numeric_limits<float>::infinity()})
    EXPECT_THROW(Broken(value).angles(), std::invalid_argument) << value;
}

}  // namespace
}  // namespace turbid
