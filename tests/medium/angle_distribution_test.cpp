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

struct Pair {
  double gamma, theta;
};
Pair draw(const AngleDistribution& angles, Rng& rng) {
  const double gamma = angles.sample(angles.range(), static_cast<double>(rng.next_float()));
  return {gamma, angles.sample_beyond(gamma, static_cast<double>(rng.next_float()))};
}

/// Angles against a density, as t = angle^(1/4): a tenth of the histogram lies below half a milliradian.
template <class Angle>
ChiSquareResult test_angles(const Angle& angle, const std::function<double(double)>& density, double from = 0,
                            double to = std::numbers::pi) {
  return testing::chi_square_interval(
      [&](Rng& rng) -> std::optional<double> { return std::pow(angle(rng), 0.25); },
      [&](double t) { return 4 * t * t * t * density(std::min(t * t * t * t, std::numbers::pi)); },
      std::pow(from, 0.25), std::pow(to, 0.25));
}

/// theta f / Z, not from the table.
std::function<double(double)> wanted(const PhaseFunction& phase, double z) {
  return [&phase, z](double theta) {
    return theta * static_cast<double>(phase.eval_angle(static_cast<float>(theta))) / z;
  };
}
const auto deflection = [](const AngleDistribution& angles) {
  return [&angles](Rng& rng) { return draw(angles, rng).theta; };
};

TEST(AngleDistribution, IsSampledAsItSays) {
  const auto& all = all_phase_functions();
  for (const auto& [name, phase, grows] : all) {
    const AngleDistribution& angles = phase->angles();
    // What the pairs' density leaves for theta, and theta beyond a given gamma.
    const auto deflections =
        test_angles(deflection(angles), [&](double theta) { return theta * angles.pdf(angles.range(), theta); });
    EXPECT_TRUE(passes(deflections, 2 * static_cast<int>(all.size()))) << name << ": " << deflections.report;
    EXPECT_NEAR(deflections.mass, 1, 1e-4) << name;
    constexpr double kGamma = 0.3;
    if (!(angles.pdf_beyond(kGamma, kGamma + 0.1) > 0)) continue;
    const auto beyond =
        test_angles([&](Rng& rng) { return angles.sample_beyond(kGamma, static_cast<double>(rng.next_float())); },
                    [&](double theta) { return angles.pdf_beyond(kGamma, theta); }, kGamma);
    EXPECT_TRUE(passes(beyond, 2 * static_cast<int>(all.size()))) << name << ": " << beyond.report;
    EXPECT_NEAR(beyond.mass, 1, 1e-4) << name;
  }
}

TEST(AngleDistribution, FollowsThePhaseFunction) {
  const auto& all = all_phase_functions();
  for (const auto& [name, phase, grows] : all) {
    const AngleDistribution& angles = phase->angles();
    const auto result = test_angles(deflection(angles), wanted(*phase, angles.moment()));
    EXPECT_TRUE(passes(result, static_cast<int>(all.size()))) << name << ": " << result.report;
  }
}

TEST(AngleDistribution, CanBeConfined) {
  // Isotropic: the density of gamma falls as pi - gamma.
  const IsotropicPhase isotropic;
  const auto gamma = [&](Rng& rng) {
    return isotropic.angles().sample(isotropic.angles().range(0.5, 1.25), static_cast<double>(rng.next_float()));
  };
  const auto density = [](double slope) {
    return [slope](double angle) { return slope * (std::numbers::pi - angle); };
  };
  const double norm = 0.75 * (std::numbers::pi - 0.875);
  const auto result = test_angles(gamma, density(1 / norm), 0.5, 1.25);
  EXPECT_TRUE(passes(result, 1)) << result.report;
  EXPECT_FALSE(passes(test_angles(
                          gamma, [](double) { return 1 / 0.75; }, 0.5, 1.25),
                      1))
      << "planted: uniform";
  EXPECT_NEAR(isotropic.angles().range(0.5, 1.25).moment(), norm / (4 * std::numbers::pi), 1e-7);
}

TEST(AngleDistribution, PlantedErrorsAreFound) {
  const HenyeyGreensteinPhase right(0.9f), wrong(0.905f);
  const auto angles = deflection(right.angles());
  const double z = right.angles().moment();
  EXPECT_FALSE(passes(test_angles(angles, wanted(wrong, wrong.angles().moment())), 100)) << "slightly wrong g";
  EXPECT_FALSE(passes(test_angles(angles, wanted(right, 1.02 * z)), 100)) << "wrong normalisation";
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
  // f / pdf, over samples: its mean is Z, and hardly any sample is more than 1e-3 off; for smooth peaks none more than
  // 1e-5.
  for (const auto& [name, phase, grows] : all_phase_functions()) {
    const AngleDistribution& angles = phase->angles();
    Rng rng(5);
    double sum = 0, worst = 0;
    int off = 0;
    constexpr int kSamples = 20000;
    for (int i = 0; i < kSamples; ++i) {
      const double theta = draw(angles, rng).theta;
      const double weight = static_cast<double>(phase->eval_angle(static_cast<float>(theta))) /
                            angles.pdf(angles.range(), theta) / angles.moment();
      sum += weight;
      worst = std::max(worst, std::abs(weight - 1));
      off += std::abs(weight - 1) > 1e-3;
    }
    EXPECT_NEAR(sum / kSamples, 1, 1e-4) << name;
    // The minima and the glory of large spheres, all alike, are narrow.
    EXPECT_LE(off, name.starts_with("mie 20") ? kSamples / 200 : kSamples / 1000) << name << ", worst " << worst;
    if (name.starts_with("hg 0.9") || name == "isotropic") {
      EXPECT_LT(worst, 1e-5) << name;
    }
  }
}

TEST(AngleDistribution, SamplesAreInsideAndPossible) {
  constexpr int kSamples = 1 << 17;
  for (const auto& [name, phase, grows] : all_phase_functions()) {
    const AngleDistribution& angles = phase->angles();
    int bad = 0;
    double last = -1;
    for (int i = 0; i <= kSamples; ++i) {
      const double u = std::min(static_cast<double>(i) / kSamples, 1 - 0x1p-24);
      const double gamma = angles.sample(angles.range(), u), theta = angles.sample_beyond(gamma, u);
      const double pdf = angles.pdf(angles.range(), theta);
      bad += !(gamma >= last && theta >= gamma && theta <= std::numbers::pi && std::isfinite(pdf) && pdf >= 0);
      last = gamma;
    }
    EXPECT_EQ(bad, 0) << name;
  }
}

TEST(AngleDistribution, OfAPeakHasItWhereItBelongs) {
  // The median of theta f for a narrow Henyey-Greenstein peak: int_0^m t (w^2 + t^2)^(-3/2) dt = (1/w) / 2 at
  // m = sqrt(3) w, w = (1 - g) / sqrt(g).
  for (const float g : {0.99f, 0.999f}) {
    const double width = (1 - static_cast<double>(g)) / std::sqrt(static_cast<double>(g));
    const HenyeyGreensteinPhase phase(g);
    Rng rng(3);
    int below = 0;
    constexpr int kSamples = 40000;
    for (int i = 0; i < kSamples; ++i) below += draw(phase.angles(), rng).theta < std::sqrt(3) * width;
    EXPECT_NEAR(static_cast<double>(below) / kSamples, 0.5, 0.015);
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
