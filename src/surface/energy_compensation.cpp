#include "surface/energy_compensation.h"

#include <algorithm>
#include <map>
#include <mutex>
#include <tuple>

#include "core/parallel.h"
#include "core/warp.h"
#include "surface/fresnel.h"
#include "surface/gauss_legendre.h"

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
  // The mean of the interpolated function itself, so that what the lobe gives back is exactly what the table says: in
  // every interval of t the integrand 2 m(t) t^2 2t is a polynomial of degree 4.
  const GaussLegendre exact(3);
  for (size_t side = 0; side < sides; ++side) {
    double sum = 0;
    for (size_t i = 0; i + 1 < kNodes; ++i) {
      for (size_t j = 0; j < exact.size(); ++j) {
        const double t = (double(i) + exact.node(j)) / (kNodes - 1);
        const double m = std::lerp(double(missing_[side][i]), double(missing_[side][i + 1]), exact.node(j));
        sum += exact.weight(j) / (kNodes - 1) * 4 * m * t * t * t;
      }
    }
    mean_[side] = static_cast<float>(sum);
  }
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

float EnergyCompensation::Lobe::pdf_w(const Vec3& chosen) const {
  return share[chosen.z > 0 ? 0 : 1] * std::abs(chosen.z) * kInvPi;
}

Vec3 EnergyCompensation::Lobe::sample(float u_lobe, const Vec2& u) const {
  Vec3 direction = square_to_cosine_hemisphere(u);
  if (u_lobe >= share[0]) direction.z = -direction.z;
  return direction;
}

}  // namespace turbid
