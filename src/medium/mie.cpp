#include "medium/mie.h"

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

#include "core/parallel.h"
#include "core/vector.h"
#include "medium/lorenz_mie.h"

namespace turbid {
namespace {

constexpr double kPiD = std::numbers::pi;
constexpr double kLargest = 2000, kSmallest = 0.01;  // size parameters; smaller spheres scatter as RayleighPhase says
constexpr double kMostDeviation = 1;

/// Radii that stand for a log-normal distribution, as size parameters with the numbers of spheres that each stands for.
struct Sizes {
  std::vector<double> x, number;
};

/// The trapezoidal rule in ln(radius), which converges fast for the Gaussian that the distribution is there. Large
/// spheres scatter more, by r^2 to r^6, which moves the range that matters upward by up to 4 deviation^2.
Sizes sizes(double median, double deviation) {
  if (deviation == 0) return {{median}, {1}};
  const double low = -3.5 * deviation, high = 3.5 * deviation + 4 * sqr(deviation);
  const double range = median * (std::exp(high) - std::exp(low));
  if (!(median * std::exp(high) <= kLargest))
    throw std::invalid_argument("the largest spheres have a size parameter of " +
                                std::to_string(median * std::exp(high)) + ", above " + std::to_string(kLargest));
  const int count = static_cast<int>(std::clamp(2 * range, 48.0, 256.0));  // half a wavelength around each apart
  Sizes result;
  for (int i = 0; i < count; ++i) {
    const double t = low + (high - low) * i / (count - 1);
    result.x.push_back(median * std::exp(t));
    result.number.push_back(std::exp(-sqr(t / deviation) / 2));
  }
  return result;
}

void check(const MiePhase::Parameters& p) {
  const auto require = [](bool met, const char* what, double value) {
    if (!met) throw std::invalid_argument(std::string(what) + ", not " + std::to_string(value));
  };
  require(p.radius > 0 && std::isfinite(p.radius), "the radius of spheres must be positive", p.radius);
  require(p.deviation >= 0 && p.deviation <= kMostDeviation,
          "the deviation of the logarithm of the radii must lie in [0, 1]", p.deviation);
  require(p.wavelength > 0 && std::isfinite(p.wavelength), "the wavelength must be positive", p.wavelength);
  require(p.exterior_ior > 0 && std::isfinite(p.exterior_ior), "the index of refraction outside must be positive",
          p.exterior_ior);
  require(p.interior_ior != p.exterior_ior || p.interior_k > 0, "spheres must differ from what is around them in index",
          p.interior_ior);
}

}  // namespace

MiePhase::MiePhase(const Parameters& p) {
  check(p);
  const std::complex<double> m(p.interior_ior / p.exterior_ior, p.interior_k / p.exterior_ior);
  const double median = 2 * kPiD * p.radius * 1000 * p.exterior_ior / p.wavelength;
  if (!(median >= kSmallest && median <= kLargest))
    throw std::invalid_argument("the spheres have a size parameter of " + std::to_string(median) +
                                ", which must lie in [0.01, 2000]");
  const Sizes all = sizes(median, p.deviation);
  std::vector<std::unique_ptr<LorenzMie>> spheres(all.x.size());
  parallel_for(spheres.size(), [&](size_t i) { spheres[i] = std::make_unique<LorenzMie>(m, all.x[i]); });

  double extinction = 0, scattering = 0, forward = 0;
  for (size_t i = 0; i < spheres.size(); ++i) {
    const double area = all.number[i] * sqr(all.x[i]);
    extinction += area * spheres[i]->extinction();
    scattering += area * spheres[i]->scattering();
    forward += area * spheres[i]->scattering() * spheres[i]->mean_cosine();
  }
  series_mean_cosine_ = forward / scattering;
  albedo_ = scattering / extinction;

  const auto intensity = [&](double theta) {
    const MultipolePatterns patterns(std::cos(theta), spheres.back()->count());  // the largest sphere has most
    double sum = 0;
    for (size_t i = 0; i < spheres.size(); ++i) {
      const LorenzMie::Amplitudes s = spheres[i]->amplitudes(patterns);
      sum += all.number[i] * (std::norm(s.s1) + std::norm(s.s2));
    }
    return sum;
  };
  // Over angle the intensity oscillates with a period of pi / x, which spheres of many radii smooth out.
  const int start_count = static_cast<int>(std::clamp(8 * median, 64.0, 2048.0));
  std::vector<double> start;
  for (int i = 0; i <= start_count; ++i) start.push_back(kPiD * i / start_count);
  const std::vector<Node> nodes = refine(intensity, [](double theta) { return sqr(std::sin(theta / 2)); }, start,
                                         {.tolerance = 2e-3, .most_nodes = 4096, .in_parallel = true});
  table_ = std::make_unique<AngularTablePhase>(nodes);
}

}  // namespace turbid
