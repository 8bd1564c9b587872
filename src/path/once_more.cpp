#include "path/once_more.h"

#include <cmath>

#include "core/frame.h"
#include "medium/angle_distribution.h"

namespace turbid {
namespace {

constexpr double kTwoPi = 2 * std::numbers::pi;

/// Density in theta, 1/rad: what is integrated over the azimuth, so 2 pi sin(theta) f for sampling in solid angle.
double pdf_theta(const PhaseFunction& phase, Insertion insertion, float theta) {
  if (insertion == Insertion::kAngle) return static_cast<double>(phase.angles().pdf(theta));
  if (theta >= kPi / 2) return 0;
  return kTwoPi * std::sin(static_cast<double>(theta)) * static_cast<double>(phase.eval_angle(theta));
}

/// From theta, beta uniform in (0, theta) and phi uniform to the volume.
double to_volume(double pdf_theta, double theta, double s, double d1, double d2) {
  return pdf_theta / theta / kTwoPi * s / (d1 * d1 * d2 * d2);
}

}  // namespace

std::optional<InsertedCollision> insert_collision(const PhaseFunction& phase, const Vec3& x0, const Vec3& x2,
                                                  Insertion insertion, float u_theta, float u_beta, float u_phi) {
  const float s = length(x2 - x0);
  if (!(s > 0)) return std::nullopt;
  float theta = 0;
  if (insertion == Insertion::kAngle) {
    theta = phase.angles().sample(u_theta);
  } else {
    const float mu = phase.sample(u_theta);
    if (mu <= 0) return std::nullopt;
    theta = std::acos(std::min(mu, 1.0f));
  }
  const float beta = u_beta * theta, rest = theta - beta;
  const double sine = std::sin(static_cast<double>(theta));
  InsertedCollision result;
  result.theta = theta;
  // Law of sines; angles and their sines are exact to the last digits, however small.
  const double d1 = static_cast<double>(s) * std::sin(static_cast<double>(rest)) / sine;
  const double d2 = static_cast<double>(s) * std::sin(static_cast<double>(beta)) / sine;
  result.d1 = static_cast<float>(d1);
  result.d2 = static_cast<float>(d2);
  if (!(result.d1 > 0) || !(result.d2 > 0) || !std::isfinite(result.d1 * result.d1) ||
      !std::isfinite(result.d2 * result.d2))
    return std::nullopt;
  const Frame frame((x2 - x0) / s);
  const float phi = 2 * kPi * u_phi;
  const Vec3 aside = frame.s * std::cos(phi) + frame.t * std::sin(phi);
  result.arrives = frame.n * std::cos(beta) + aside * std::sin(beta);
  result.leaves = frame.n * std::cos(rest) - aside * std::sin(rest);
  // From the nearer end, whose rounding is smaller.
  result.position = d1 < d2 ? x0 + result.arrives * result.d1 : x2 - result.leaves * result.d2;
  result.f = phase.eval_angle(theta);
  result.pdf_v =
      to_volume(pdf_theta(phase, insertion, theta), static_cast<double>(theta), static_cast<double>(s), d1, d2);
  if (!(result.pdf_v > 0) || !std::isfinite(result.pdf_v)) return std::nullopt;
  return result;
}

double insertion_pdf_v(const PhaseFunction& phase, const Vec3& x0, const Vec3& x1, const Vec3& x2,
                       Insertion insertion) {
  const Vec3 first = x1 - x0, second = x2 - x1;
  const double s = static_cast<double>(length(x2 - x0)), d1 = static_cast<double>(length(first)),
               d2 = static_cast<double>(length(second));
  if (!(s > 0) || !(d1 > 0) || !(d2 > 0)) return 0;
  // The angle by its sine and cosine: neither loses digits near 0 or pi.
  const double theta =
      std::atan2(static_cast<double>(length(cross(first, second))), static_cast<double>(dot(first, second)));
  if (!(theta > 0)) return 0;
  const double pdf = to_volume(pdf_theta(phase, insertion, static_cast<float>(theta)), theta, s, d1, d2);
  return std::isfinite(pdf) ? pdf : 0;
}

}  // namespace turbid
