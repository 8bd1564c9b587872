#include "surface/energy_compensation.h"

#include <algorithm>
#include <map>
#include <mutex>
#include <tuple>

#include "core/gauss_legendre.h"
#include "core/parallel.h"
#include "surface/fresnel.h"

namespace turbid {
namespace {

/// Energy that leaves after one facet, of a given direction of cosine mu; eta = other side / this side, 0: all is
/// reflected.
double single_scattering_albedo(const MicrofacetDistribution& distribution, float mu, float eta,
                                const GaussLegendre& rule) {
  const Vec3 v(safe_sqrt(1 - mu * mu), 0, mu);
  double sum = 0;
  for (size_t i = 0; i < rule.size(); ++i) {
    for (size_t j = 0; j < rule.size(); ++j) {
      const Vec2 u(static_cast<float>(rule.node(i)), static_cast<float>(rule.node(j)));
      const Vec3 m = distribution.sample_visible(v, u);
      const float cosine = dot(v, m);
      if (cosine <= 0) continue;
      const FresnelDielectric fresnel = eta > 0 ? fresnel_dielectric(cosine, eta) : FresnelDielectric{1, 0};
      const Vec3 reflected = m * (2 * cosine) - v;
      double seen = 0;
      if (reflected.z > 0) seen += double(fresnel.reflectance * distribution.g1(reflected, m));
      if (fresnel.reflectance < 1) {
        const Vec3 refracted = m * (cosine / eta - fresnel.cos_transmit) - v * (1 / eta);
        if (refracted.z < 0) seen += double((1 - fresnel.reflectance) * distribution.g1(refracted, m));
      }
      sum += rule.weight(i) * rule.weight(j) * seen;
    }
  }
  return sum;
}

/// Integral of 2 m(mu) mu dmu = 4 m(t) t^3 dt, t = sqrt(mu), over the first `part` of the cell from node i to i + 1,
/// where m goes linearly from m0 to m1. In every such piece the integrand is a polynomial of degree 4: three points are
/// exact.
double cell_integral(size_t i, double part, double m0, double m1) {
  static const GaussLegendre rule(3);
  double sum = 0;
  for (size_t j = 0; j < rule.size(); ++j) {
    const double x = rule.node(j) * part, t = (double(i) + x) / (EnergyTable::kNodes - 1);
    sum += rule.weight(j) * 4 * std::lerp(m0, m1, x) * t * t * t;
  }
  return sum * part / (EnergyTable::kNodes - 1);
}

/// Roughnesses of the tables between which a textured roughness is interpolated.
constexpr size_t kAlphaNodes = 12;
float alpha_node(size_t k) { return sqr(static_cast<float>(k) / (kAlphaNodes - 1)); }

}  // namespace

EnergyTable::EnergyTable(MicrofacetType type, float alpha, float eta) {
  const MicrofacetDistribution distribution(type, alpha, alpha);
  const GaussLegendre rule(40);
  const size_t sides = eta > 0 ? 2 : 1;
  parallel_for(sides * kNodes, [&](size_t task) {
    const size_t side = task / kNodes, i = task % kNodes;
    const float t = static_cast<float>(i) / (kNodes - 1), mu = std::max(t * t, 1e-5f);
    const double seen = single_scattering_albedo(distribution, mu, side == 0 ? eta : 1 / eta, rule);
    missing_[side][i] = static_cast<float>(std::clamp(1 - seen, 0.0, 1.0));
  });
  // The mean of the interpolated function itself, so that what the lobe gives back is exactly what the table says.
  for (size_t side = 0; side < sides; ++side) {
    double sum = 0;
    for (size_t i = 0; i + 1 < kNodes; ++i) {
      sum += cell_integral(i, 1, double(missing_[side][i]), double(missing_[side][i + 1]));
      cumulative_[side][i + 1] = static_cast<float>(sum);
    }
    mean_[side] = static_cast<float>(sum);
  }
}

float EnergyTable::sample_cosine(int side, float u) const {
  const auto& sums = cumulative_[static_cast<size_t>(side)];
  const auto& nodes = missing_[static_cast<size_t>(side)];
  const double target = double(u) * double(mean(side));
  const auto above = std::upper_bound(sums.begin() + 1, sums.end() - 1, static_cast<float>(target));
  const auto cell = static_cast<size_t>(above - sums.begin()) - 1;
  const double rest = target - double(sums[cell]);
  double low = 0, high = 1;
  for (int i = 0; i < 26; ++i) {
    const double middle = (low + high) / 2;
    (cell_integral(cell, middle, double(nodes[cell]), double(nodes[cell + 1])) < rest ? low : high) = middle;
  }
  return static_cast<float>(sqr((double(cell) + (low + high) / 2) / (kNodes - 1)));
}

std::shared_ptr<const EnergyTable> EnergyTable::shared(MicrofacetType type, float alpha, float eta) {
  static std::mutex mutex;
  static std::map<std::tuple<MicrofacetType, float, float>, std::weak_ptr<const EnergyTable>> tables;
  const auto key = std::tuple(type, alpha, eta);
  {
    const std::lock_guard lock(mutex);
    if (auto table = tables[key].lock()) return table;
  }
  auto table = std::make_shared<const EnergyTable>(type, alpha, eta);  // outside of the lock: it runs in parallel
  const std::lock_guard lock(mutex);
  tables[key] = table;
  return table;
}

float EnergyTable::missing(int side, float cosine) const {
  const float x = std::sqrt(std::clamp(cosine, 0.0f, 1.0f)) * (kNodes - 1);
  const size_t i = std::min(static_cast<size_t>(x), kNodes - 2);
  const auto& nodes = missing_[static_cast<size_t>(side)];
  return std::lerp(nodes[i], nodes[i + 1], x - static_cast<float>(i));
}

EnergyCompensation::EnergyCompensation(const RoughnessValue& roughness, float eta) : eta_(eta) {
  if (roughness.is_constant()) {
    tables_.push_back(EnergyTable::shared(roughness.type(), roughness.mean_alpha(SurfacePoint{}), eta));
    return;
  }
  for (size_t k = 0; k < kAlphaNodes; ++k) tables_.push_back(EnergyTable::shared(roughness.type(), alpha_node(k), eta));
}

EnergyCompensation::Lobe EnergyCompensation::at(float alpha, const Vec3& given) const {
  Lobe lobe;
  size_t i = 0;
  if (tables_.size() > 1) {
    const float x = std::sqrt(std::clamp(alpha, 0.0f, 1.0f)) * (kAlphaNodes - 1);
    i = std::min(static_cast<size_t>(x), kAlphaNodes - 2);
    lobe.t = (alpha - alpha_node(i)) / (alpha_node(i + 1) - alpha_node(i));
    lobe.t = std::clamp(lobe.t, 0.0f, 1.0f);
  }
  lobe.low = tables_[i].get();
  lobe.high = tables_[std::min(i + 1, tables_.size() - 1)].get();
  const std::array<float, 2> mean = {std::lerp(lobe.low->mean(0), lobe.high->mean(0), lobe.t),
                                     std::lerp(lobe.low->mean(1), lobe.high->mean(1), lobe.t)};
  const float total = mean[0] + sqr(eta_) * mean[1];
  constexpr float kNothing = 1e-7f;  // smooth surfaces lose less than float can tell
  if (!(total > kNothing)) return lobe;
  lobe.share = {mean[0] / total, sqr(eta_) * mean[1] / total};
  for (size_t j = 0; j < 2; ++j) lobe.inverse_mean[j] = mean[j] > 0 ? 1 / mean[j] : 0;
  lobe.missing = lobe.missing_at(given);
  return lobe;
}

float EnergyCompensation::Lobe::missing_at(const Vec3& direction) const {
  const int side = direction.z > 0 ? 0 : 1;
  const float cosine = std::abs(direction.z);
  return std::lerp(low->missing(side, cosine), high->missing(side, cosine), t);
}

float EnergyCompensation::Lobe::value(const Vec3& chosen) const {
  const size_t side = chosen.z > 0 ? 0 : 1;
  if (missing == 0 || share[side] == 0) return 0;
  return missing * share[side] * missing_at(chosen) * inverse_mean[side] * std::abs(chosen.z) * kInvPi;
}

float EnergyCompensation::Lobe::pdf_w(const Vec3& chosen) const { return missing > 0 ? value(chosen) / missing : 0; }

Vec3 EnergyCompensation::Lobe::sample(float u_lobe, const Vec2& u) const {
  const bool outside = u_lobe < share[0];
  const int side = outside ? 0 : 1;
  // Between two tables the density is their mixture, weighted by their means.
  const float rescaled = outside ? u_lobe / share[0] : (u_lobe - share[0]) / (1 - share[0]);
  const float prob_high = t * high->mean(side) * inverse_mean[outside ? 0 : 1];
  const float cosine = (rescaled < prob_high ? high : low)->sample_cosine(side, u.x);
  const float sine = safe_sqrt(1 - cosine * cosine), phi = 2 * kPi * u.y;
  return {sine * std::cos(phi), sine * std::sin(phi), outside ? cosine : -cosine};
}

}  // namespace turbid
