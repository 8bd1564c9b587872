// Lorenz-Mie: the series against published values, conservation laws and limits; the table against the
// series.
#include "medium/mie.h"

#include <gtest/gtest.h>

#include <numbers>

#include "medium/lorenz_mie.h"
#include "medium/phases_for_tests.h"
#include "medium/rayleigh.h"

namespace turbid {
namespace {

using Complex = std::complex<double>;
using Parameters = MiePhase::Parameters;
constexpr double kPiD = std::numbers::pi;

TEST(LorenzMie, HasTheEfficienciesOfWiscombe) {
  // The test cases of Wiscombe 1979, whose m is the complex conjugate.
  struct Case {
    Complex m;
    double x, extinction, scattering, mean_cosine;
  };
  for (const Case& c : {Case{{0.75, 0}, 0.099, 7.417859e-6, 7.417859e-6, 0.001448},
                        {{0.75, 0}, 10, 2.232265, 2.232265, 0.896473},
                        {{0.75, 0}, 1000, 1.997908, 1.997908, 0.844944},
                        {{1.33, 1e-5}, 1, 0.09395198, 0.09392330, 0.184517},
                        {{1.33, 1e-5}, 100, 2.101321, 2.096594, 0.868959},
                        {{1.33, 1e-5}, 10000, 2.004089, 1.723857, 0.907840},
                        {{1.5, 1}, 0.055, 0.1014910, 1.131687e-5, 0.000491},
                        {{1.5, 1}, 1, 2.336321, 0.6634538, 0.192136},
                        {{1.5, 1}, 100, 2.097502, 1.283697, 0.850252},
                        {{1.5, 1}, 10000, 2.004368, 1.236575, 0.846309},
                        {{10, 10}, 1, 2.532993, 2.049405, -0.110664},
                        {{10, 10}, 100, 2.071124, 1.836785, 0.556215},
                        {{10, 10}, 10000, 2.005914, 1.795393, 0.548194}}) {
    const LorenzMie sphere(c.m, c.x);
    EXPECT_NEAR(sphere.extinction() / c.extinction, 1, 1e-6) << c.m << ' ' << c.x;
    EXPECT_NEAR(sphere.scattering() / c.scattering, 1, 1e-6) << c.m << ' ' << c.x;
    EXPECT_NEAR(sphere.mean_cosine(), c.mean_cosine, 1e-6) << c.m << ' ' << c.x;
  }
}

TEST(LorenzMie, HasTheAmplitudesOfWiscombe) {
  // At 0, 30 ... degrees, conjugated as above.
  const LorenzMie sphere({1.5, 1}, 1);
  const std::vector<Complex> s1{{0.584080, -0.190515}, {0.565702, -0.187200}, {0.517525, -0.178443},
                                {0.456340, -0.167167}, {0.400212, -0.156643}, {0.362157, -0.149391},
                                {0.348844, -0.146829}};
  const std::vector<Complex> s2{{0.584080, -0.190515},
                                {0.500161, -0.145611},
                                {0.287964, -0.041054},
                                {0.0362285, 0.0618265},
                                {-0.174875, 0.122959}};
  for (size_t i = 0; i < s1.size(); ++i) {
    const LorenzMie::Amplitudes s = sphere.amplitudes(std::cos(static_cast<double>(i) * kPiD / 6));
    EXPECT_LT(std::abs(s.s1 - s1[i]), 1e-6) << 30 * i;
    if (i < s2.size()) {
      EXPECT_LT(std::abs(s.s2 - s2[i]), 1e-6) << 30 * i;
    }
  }
}

TEST(LorenzMie, HasTheExampleOfBohrenAndHuffman) {
  // Bohren & Huffman 1983, appendix A: n = 1.55, radius 0.525 um, 632.8 nm.
  const double x = 2 * kPiD * 0.525 / 0.6328;
  const LorenzMie sphere(1.55, x);
  EXPECT_NEAR(sphere.extinction(), 3.10543, 5e-6);
  EXPECT_NEAR(sphere.scattering(), 3.10543, 5e-6);
  EXPECT_NEAR(4 * std::norm(sphere.amplitudes(-1).s1) / (x * x), 2.92534, 5e-6);
}

TEST(LorenzMie, KeepsTheLawsOfConservation) {
  for (const auto& [m, x] : {std::pair{Complex(1.33), 0.01}, {Complex(1.33), 20.0}, {Complex(1.6, 0.1), 300.0}}) {
    const LorenzMie sphere(m, x);
    // Optical theorem: extinction is what is missing straight on.
    EXPECT_NEAR(4 / (x * x) * sphere.amplitudes(1).s1.real() / sphere.extinction(), 1, 1e-9);
    // What goes into all directions is scattering: int (|S1|^2 + |S2|^2) / 2 dOmega = pi x^2 Q.
    const double all = testing::integrate_interval(
        [&](double theta) {
          const LorenzMie::Amplitudes s = sphere.amplitudes(std::cos(theta));
          return kPiD * std::sin(theta) * (std::norm(s.s1) + std::norm(s.s2));
        },
        0, kPiD, 1e-9 * x * x, 9, 14);
    EXPECT_NEAR(all / (kPiD * x * x * sphere.scattering()), 1, 1e-6) << x;
    if (m.imag() == 0) {
      EXPECT_NEAR(sphere.scattering() / sphere.extinction(), 1, 1e-9);
    }
  }
  // Rayleigh 1871: Q = 8/3 x^4 |(m^2 - 1) / (m^2 + 2)|^2 for small spheres.
  const double x = 0.005, ratio = (1.5 * 1.5 - 1) / (1.5 * 1.5 + 2);
  EXPECT_NEAR(LorenzMie(1.5, x).scattering() / (8.0 / 3 * std::pow(x, 4) * ratio * ratio), 1, 1e-4);
}

TEST(LorenzMie, RefusesImpossibleSpheres) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Complex m : {Complex(0), Complex(-1), Complex(1.3, -0.1), Complex(nan), Complex(1.3, nan)})
    EXPECT_THROW(LorenzMie(m, 1), std::invalid_argument) << m;
  for (const double x : {0.0, 1e-4, 1e5, nan}) EXPECT_THROW(LorenzMie(1.33, x), std::invalid_argument) << x;
}

TEST(Mie, TableMeetsTheSeries) {
  for (const double radius : {0.02, 0.3, 2.0, 10.0}) {
    const MiePhase phase({.radius = radius, .deviation = 0});
    const double x = 2 * kPiD * radius * 1000 / 550;
    const LorenzMie sphere(1.33, x);
    EXPECT_NEAR(phase.mean_cosine(), sphere.mean_cosine(), 1e-4) << radius;
    EXPECT_NEAR(phase.series_mean_cosine(), sphere.mean_cosine(), 1e-9) << radius;
    int off = 0;
    for (int i = 0; i <= 1000; ++i) {
      const double theta = kPiD * i / 1000;
      const LorenzMie::Amplitudes s = sphere.amplitudes(std::cos(theta));
      const double expected = (std::norm(s.s1) + std::norm(s.s2)) / 2 / (kPiD * x * x * sphere.scattering());
      const auto seen = static_cast<double>(phase.eval_angle(static_cast<float>(theta)));
      off += std::abs(seen / expected - 1) > 2e-3;
      EXPECT_NEAR(seen / expected, 1, 0.05) << radius << " at " << theta;
    }
    EXPECT_LE(off, 20) << radius;  // in deep minima
  }
}

TEST(Mie, OfTinySpheresIsRayleigh) {
  const MiePhase phase({.radius = 0.001, .deviation = 0});
  for (const float mu : {-1.0f, -0.5f, 0.0f, 0.7f, 1.0f})
    EXPECT_NEAR(phase.eval(mu) / RayleighPhase().eval(mu), 1, 1e-3f);
}

TEST(Mie, AveragesOverRadii) {
  // Against a plain sum over many radii.
  const Parameters p{.radius = 0.4, .deviation = 0.3};
  double expected[3] = {}, scattering = 0;
  const double mu[3] = {1, 0.2, -0.9};
  for (double t = -1.5; t < 1.5 + 0.5; t += 0.002) {
    const double x = 2 * kPiD * p.radius * 1000 / p.wavelength * std::exp(t);
    const double number = std::exp(-t * t / (2 * p.deviation * p.deviation));
    const LorenzMie sphere(p.interior_ior, x);
    scattering += number * kPiD * x * x * sphere.scattering();
    for (size_t i = 0; i < 3; ++i) {
      const LorenzMie::Amplitudes s = sphere.amplitudes(mu[i]);
      expected[i] += number * (std::norm(s.s1) + std::norm(s.s2)) / 2;
    }
  }
  const MiePhase phase(p);
  for (size_t i = 0; i < 3; ++i)
    EXPECT_NEAR(static_cast<double>(phase.eval(static_cast<float>(mu[i]))) / (expected[i] / scattering), 1, 5e-3);
}

TEST(Mie, KnowsWhatSpheresAbsorb) {
  EXPECT_NEAR(MiePhase({.radius = 1}).albedo(), 1, 1e-9);
  const MiePhase soot({.radius = 0.05, .deviation = 0, .interior_ior = 1.75, .interior_k = 0.5});
  const LorenzMie sphere({1.75, 0.5}, 2 * kPiD * 50 / 550);
  EXPECT_NEAR(soot.albedo(), sphere.scattering() / sphere.extinction(), 1e-9);
  EXPECT_LT(soot.albedo(), 0.3);
}

TEST(Mie, GoesByTheIndexOutside) {
  // Only the relative index and the wavelength outside count.
  const MiePhase in_water({.radius = 1, .interior_ior = 1.6, .exterior_ior = 1.33, .wavelength = 550});
  const MiePhase in_air({.radius = 1, .interior_ior = 1.6 / 1.33, .exterior_ior = 1, .wavelength = 550 / 1.33});
  for (const float mu : {-1.0f, 0.0f, 0.9f}) EXPECT_NEAR(in_water.eval(mu) / in_air.eval(mu), 1, 1e-4f);
}

TEST(Mie, PlantedErrorsAreFound) {
  const MiePhase right({.radius = 1});
  EXPECT_FALSE(passes(testing::test_samples(right, MiePhase({.radius = 1.05})), 100));
  EXPECT_FALSE(passes(testing::test_samples(right, MiePhase({.radius = 1, .interior_ior = 1.35})), 100));
}

TEST(Mie, RefusesImpossibleSpheres) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Parameters& p :
       {Parameters{.radius = 0}, Parameters{.radius = nan}, Parameters{.radius = 1000}, Parameters{.radius = 1e-5},
        Parameters{.deviation = -0.1}, Parameters{.deviation = 1.5}, Parameters{.deviation = nan},
        Parameters{.radius = 100, .deviation = 1}, Parameters{.interior_ior = 0}, Parameters{.interior_ior = 1},
        Parameters{.interior_k = -1}, Parameters{.exterior_ior = 0}, Parameters{.exterior_ior = nan},
        Parameters{.wavelength = 0}, Parameters{.wavelength = nan}})
    EXPECT_THROW(MiePhase{p}, std::invalid_argument);
}

}  // namespace
}  // namespace turbid
