#include "surface/microfacet.h"

#include <algorithm>

#include "core/warp.h"

namespace turbid {
namespace {

constexpr float kInvSqrtPi = std::numbers::inv_sqrtpi_v<float>;

/// The inverse error function for |x| < 1, relative error below 1e-6 (Giles 2010, "Approximating the erfinv function",
/// table 5). Double so that 1 - |x| keeps its digits.
double inverse_erf(double x) {
  double w = -std::log((1 - x) * (1 + x));
  if (w < 5) {
    w -= 2.5;
    double p = 2.81022636e-08;
    for (const double c : {3.43273939e-07, -3.5233877e-06, -4.39150654e-06, 0.00021858087, -0.00125372503,
                           -0.00417768164, 0.246640727, 1.50140941})
      p = c + p * w;
    return p * x;
  }
  w = std::sqrt(w) - 3;
  double p = -0.000200214257;
  for (const double c : {0.000100950558, 0.00134934322, -0.00367342844, 0.00573950773, -0.0076224613, 0.00943887047,
                         1.00167406, 2.83297682})
    p = c + p * w;
  return p * x;
}

/// A slope along the direction of view, seen from the angle with this cosine, of a Gaussian surface of roughness 1:
/// inverts the distribution of visible slopes h(x) = 1 + x + tan/sqrt(pi) exp(-erfinv(x)^2), x = erf(slope) (Jakob
/// 2014). h is concave and rises up to slope = cot, so Newton's method inside of a bracket converges.
float visible_beckmann_slope(float cosine, float u_clamped) {
  const double u = std::clamp(double(u_clamped), 1e-7, 1 - 1e-7);
  const double tangent = std::sqrt(std::max(0.0, 1 - sqr(double(cosine)))) / std::max(double(cosine), 1e-7);
  if (tangent < 1e-4) return static_cast<float>(inverse_erf(2 * u - 1));
  constexpr double inv_sqrt_pi = std::numbers::inv_sqrtpi_v<double>;
  const double cotangent = 1 / tangent, top = std::erf(cotangent);
  const double target = u * (1 + top + inv_sqrt_pi * tangent * std::exp(-sqr(cotangent)));
  constexpr double kEdge = 1 - 1e-12;
  double low = -kEdge, high = std::min(top, kEdge);
  // Exact for grazing views, which are the least linear.
  double x = std::clamp(top - (top + 1) * std::erf(std::sqrt(-std::log(u))), low, high);
  double slope = inverse_erf(x);
  for (int i = 0; i < 20; ++i) {
    const double excess = 1 + x + inv_sqrt_pi * tangent * std::exp(-slope * slope) - target;
    if (std::abs(excess) < 1e-6 * target) break;
    (excess > 0 ? high : low) = x;
    x -= excess / (1 - slope * tangent);
    if (!(x > low && x < high)) x = (low + high) / 2;
    slope = inverse_erf(x);
  }
  return static_cast<float>(slope);
}

}  // namespace

MicrofacetDistribution::MicrofacetDistribution(MicrofacetType type, float alpha_u, float alpha_v)
    : type_(type), alpha_u_(std::max(alpha_u, kMinAlpha)), alpha_v_(std::max(alpha_v, kMinAlpha)) {}

float MicrofacetDistribution::d(const Vec3& m) const {
  if (!(m.z > 0)) return 0;
  const float z2 = m.z * m.z, slopes = sqr(m.x / alpha_u_) + sqr(m.y / alpha_v_);
  const float norm = kPi * alpha_u_ * alpha_v_;
  if (type_ == MicrofacetType::kGgx) return 1 / (norm * sqr(slopes + z2));
  const float exponential = std::exp(-slopes / z2);
  return exponential > 0 ? exponential / (norm * z2 * z2) : 0;
}

float MicrofacetDistribution::g1(const Vec3& v, const Vec3& m) const {
  if (dot(v, m) * v.z <= 0) return 0;
  const float stretched2 = sqr(alpha_u_ * v.x) + sqr(alpha_v_ * v.y), z2 = v.z * v.z;
  if (type_ == MicrofacetType::kGgx) {
    const float z = std::abs(v.z);
    return 2 * z / (z + std::sqrt(z2 + stretched2));
  }
  constexpr float kNoMasking = 4;  // beyond this cotangent (in roughnesses) masking is below 1e-8
  if (z2 >= sqr(kNoMasking) * stretched2) return 1;
  const float a = std::sqrt(z2 / stretched2);
  return 2 / (1 + std::erf(a) + kInvSqrtPi * std::exp(-a * a) / a);
}

Vec3 MicrofacetDistribution::sample_visible(const Vec3& v, const Vec2& u) const {
  const Vec3 stretched = normalize(Vec3(alpha_u_ * v.x, alpha_v_ * v.y, v.z));
  const float sine2 = sqr(stretched.x) + sqr(stretched.y);
  if (type_ == MicrofacetType::kGgx) {
    const Vec3 t1 = sine2 > 0 ? Vec3(-stretched.y, stretched.x, 0) * (1 / std::sqrt(sine2)) : Vec3(1, 0, 0);
    const Vec3 t2 = cross(stretched, t1);
    const Vec2 p = square_to_disk(u);
    const float s = 0.5f * (1 + stretched.z);
    const float y = (1 - s) * safe_sqrt(1 - p.x * p.x) + s * p.y;
    const Vec3 n = t1 * p.x + t2 * y + stretched * safe_sqrt(1 - p.x * p.x - y * y);
    return normalize(Vec3(alpha_u_ * n.x, alpha_v_ * n.y, std::max(1e-6f, n.z)));
  }
  const float along = visible_beckmann_slope(stretched.z, u.x);
  const auto across = static_cast<float>(inverse_erf(std::clamp(2 * double(u.y) - 1, -1 + 1e-7, 1 - 1e-7)));
  const float sine = std::sqrt(sine2);
  const float cos_phi = sine > 0 ? stretched.x / sine : 1, sin_phi = sine > 0 ? stretched.y / sine : 0;
  return normalize(
      Vec3(-(cos_phi * along - sin_phi * across) * alpha_u_, -(sin_phi * along + cos_phi * across) * alpha_v_, 1));
}

float MicrofacetDistribution::pdf_visible(const Vec3& v, const Vec3& m) const {
  return g1(v, m) * std::abs(dot(v, m)) * d(m) / v.z;
}

Vec3 MicrofacetDistribution::sample_all(const Vec2& u) const {
  // Slopes of roughness 1 in polar form, then stretched: both densities depend on the stretched slopes' length alone.
  const float slope = type_ == MicrofacetType::kGgx ? std::sqrt(u.x / std::max(1 - u.x, 1e-7f))
                                                    : std::sqrt(-std::log(std::max(1 - u.x, 1e-7f)));
  const float phi = 2 * kPi * u.y;
  return normalize(Vec3(slope * std::cos(phi) * alpha_u_, slope * std::sin(phi) * alpha_v_, 1));
}

}  // namespace turbid
