#pragma once
#include <complex>
#include <cstddef>
#include <vector>

namespace turbid {

/// How the multipoles n = 1 ... count radiate at cos(theta) = mu, with their weights: (2n+1)/(n (n+1)) (pi_n + tau_n)
/// and the same with the difference. The same for all spheres, and worth sharing among them.
struct MultipolePatterns {
  MultipolePatterns(double mu, size_t count);
  std::vector<double> sum, difference;
};

/// The field that a homogeneous sphere scatters from a plane wave, as a series over multipoles (Lorenz 1890, Mie 1908,
/// in the notation of Bohren & Huffman 1983). For any relative index of refraction m = n + i k, k >= 0 absorbing, and
/// size parameter x = 2 pi radius / wavelength, both in the surrounding medium.
class LorenzMie {
 public:
  /// Computes the coefficients; their number is about x + 4 x^(1/3) (Wiscombe 1980). Throws std::invalid_argument
  /// unless n > 0, k >= 0, and x lies in [1e-3, 2e4].
  LorenzMie(std::complex<double> m, double x);

  /// Cross-sections of extinction and scattering divided by the sphere's disk.
  double extinction() const { return extinction_; }
  double scattering() const { return scattering_; }
  /// Mean cosine of the deflection.
  double mean_cosine() const { return mean_cosine_; }

  /// The amplitudes S1 (polarised across the plane of scattering) and S2 (in it) at cos(theta) = mu. Unpolarised light
  /// scatters as (|S1|^2 + |S2|^2) / 2, which is (2 pi / wavelength)^2 times the differential cross-section.
  struct Amplitudes {
    std::complex<double> s1, s2;
  };
  Amplitudes amplitudes(double mu) const { return amplitudes(MultipolePatterns(mu, count())); }
  /// The same, from at least count() patterns.
  Amplitudes amplitudes(const MultipolePatterns& patterns) const;
  size_t count() const { return sum_.size(); }

 private:
  std::vector<std::complex<double>> sum_, difference_;  ///< a_n + b_n and a_n - b_n of n = 1, 2, ...
  double extinction_ = 0, scattering_ = 0, mean_cosine_ = 0;
};

}  // namespace turbid
