#include "medium/lorenz_mie.h"

#include <cmath>
#include <stdexcept>
#include <string>

#include "core/vector.h"

namespace turbid {
namespace {

using Complex = std::complex<double>;

/// D_n = psi_n' / psi_n at z, for n = 0 ... last: downward recurrence, which is stable for any z. It forgets its start
/// value above the turning point n = |z|, in steps of |z|^(1/3): eight of them leave 1e-18 of it.
std::vector<Complex> logarithmic_derivatives(Complex z, int last) {
  const int first = std::max(last, static_cast<int>(std::abs(z) + 8 * std::cbrt(std::abs(z)))) + 16;
  std::vector<Complex> result(static_cast<size_t>(last) + 1);
  Complex d = 0;
  for (int n = first; n >= 1; --n) {
    const Complex ratio = static_cast<double>(n) / z;
    d = ratio - 1.0 / (d + ratio);
    if (n - 1 <= last) result[static_cast<size_t>(n - 1)] = d;
  }
  return result;
}

}  // namespace

LorenzMie::LorenzMie(std::complex<double> m, double x) {
  if (!(m.real() > 0) || !(m.imag() >= 0) || !std::isfinite(m.real()) || !std::isfinite(m.imag()))
    throw std::invalid_argument(
        "the relative index of refraction of a sphere must have a positive real part and no "
        "negative imaginary part");
  if (!(x >= 1e-3 && x <= 2e4))
    throw std::invalid_argument("the size parameter of a sphere must lie in [0.001, 20000], " + std::to_string(x) +
                                " does not");

  const int count = static_cast<int>(std::ceil(x + 4.05 * std::cbrt(x) + 2));
  const std::vector<Complex> derivatives = logarithmic_derivatives(m * x, count);
  // Riccati-Bessel functions psi = x j, chi = -x y, of orders n - 1 and n, upward; xi = psi - i chi.
  double psi_before = std::cos(x), psi = std::sin(x), chi_before = -std::sin(x), chi = std::cos(x);
  std::vector<Complex> a, b;
  for (int n = 1; n <= count; ++n) {
    const double step = (2 * n - 1) / x;
    const double psi_n = step * psi - psi_before, chi_n = step * chi - chi_before;
    psi_before = psi, psi = psi_n;
    chi_before = chi, chi = chi_n;
    const Complex xi_before(psi_before, -chi_before), xi(psi, -chi);
    const Complex d = derivatives[static_cast<size_t>(n)];
    const Complex electric = d / m + n / x, magnetic = d * m + n / x;
    a.push_back((electric * psi - psi_before) / (electric * xi - xi_before));
    b.push_back((magnetic * psi - psi_before) / (magnetic * xi - xi_before));
  }

  double asymmetry = 0;
  for (size_t i = 0; i < a.size(); ++i) {
    const auto n = static_cast<double>(i + 1);
    sum_.push_back(a[i] + b[i]);
    difference_.push_back(a[i] - b[i]);
    extinction_ += (2 * n + 1) * (a[i] + b[i]).real();
    scattering_ += (2 * n + 1) * (std::norm(a[i]) + std::norm(b[i]));
    asymmetry += (2 * n + 1) / (n * (n + 1)) * (a[i] * std::conj(b[i])).real();
    if (i + 1 < a.size())
      asymmetry += n * (n + 2) / (n + 1) * (a[i] * std::conj(a[i + 1]) + b[i] * std::conj(b[i + 1])).real();
  }
  mean_cosine_ = 2 * asymmetry / scattering_;
  extinction_ *= 2 / sqr(x);
  scattering_ *= 2 / sqr(x);
}

MultipolePatterns::MultipolePatterns(double mu, size_t count) {
  sum.reserve(count);
  difference.reserve(count);
  double pi_before = 0, pi = 1;  // of the orders n - 1 and n
  for (size_t i = 0; i < count; ++i) {
    const auto n = static_cast<double>(i + 1);
    const double tau = n * mu * pi - (n + 1) * pi_before, weight = (2 * n + 1) / (n * (n + 1));
    sum.push_back(weight * (pi + tau));
    difference.push_back(weight * (pi - tau));
    const double next = ((2 * n + 1) * mu * pi - (n + 1) * pi_before) / n;
    pi_before = pi, pi = next;
  }
}

LorenzMie::Amplitudes LorenzMie::amplitudes(const MultipolePatterns& patterns) const {
  // S1 = sum of weight (a pi + b tau) and S2 = sum of weight (a tau + b pi), by way of S1 + S2 and S1 - S2.
  Complex both, excess;
  for (size_t i = 0; i < sum_.size(); ++i) {
    both += patterns.sum[i] * sum_[i];
    excess += patterns.difference[i] * difference_[i];
  }
  return {0.5 * (both + excess), 0.5 * (both - excess)};
}

}  // namespace turbid
