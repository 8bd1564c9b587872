#include "path/once_more.h"

#include <cmath>

#include "core/frame.h"
#include "medium/angle_distribution.h"

namespace turbid {
namespace {

double to_double(float x) { return static_cast<double>(x); }

/// The cone of the end as seen about the line from x2 to x0: which gamma it has, and which azimuths.
struct Confines {
  double psi = 0, alpha = std::numbers::pi;  ///< between the line and the axis; half of the cone's angle
  AngleDistribution::Range gamma{};          ///< kAngle only

  Confines(const PhaseFunction& phase, const PathEnd& x2, const Vec3& x0, Insertion insertion) {
    if (insertion != Insertion::kAngle) return;
    if (!x2.cone.is_everything()) {
      psi = angle_between(x2.cone.axis, x0 - x2.place);
      alpha = x2.cone.half_angle;
    }
    gamma = phase.angles().range(std::max(0.0, psi - alpha), std::min(std::numbers::pi, psi + alpha));
  }
  /// Of azimuths from the axis, to either side.
  double half_azimuth(double at_gamma) const {
    if (at_gamma <= alpha - psi || at_gamma >= 2 * std::numbers::pi - psi - alpha) return std::numbers::pi;
    const double cosine = (std::cos(alpha) - std::cos(at_gamma) * std::cos(psi)) / (std::sin(at_gamma) * std::sin(psi));
    return std::acos(std::clamp(cosine, -1.0, 1.0));
  }
};

/// Density in theta and gamma, 1/rad^2. Not kAngle: gamma is uniform in (0, theta), and theta what is integrated over
/// the azimuth, so 2 pi sin(theta) f for sampling in solid angle.
double pdf_of_angles(const PhaseFunction& phase, Insertion insertion, const Confines& confines, double theta) {
  switch (insertion) {
    case Insertion::kAngle:
      return phase.angles().pdf(confines.gamma, theta);
    case Insertion::kGeometry:
      return 2 / sqr(std::numbers::pi);
    case Insertion::kSolidAngle:
      break;
  }
  if (theta >= std::numbers::pi / 2) return 0;
  return 2 * std::numbers::pi * std::sin(theta) * to_double(phase.eval_angle(static_cast<float>(theta))) / theta;
}

/// From theta, gamma and an azimuth uniform within half_azimuth to either side, to the volume.
double to_volume(double pdf_of_angles, double half_azimuth, double s, double d1, double d2) {
  return pdf_of_angles / (2 * half_azimuth) * s / (d1 * d1 * d2 * d2);
}

}  // namespace

std::optional<InsertedCollision> insert_collision(const PhaseFunction& phase, const Vec3& x0, const PathEnd& x2,
                                                  Insertion insertion, float u_theta, float u_gamma, float u_phi) {
  const float s = length(x2.place - x0);
  if (!(s > 0)) return std::nullopt;
  const Confines confines(phase, x2, x0, insertion);
  double theta = 0, gamma = 0;
  if (insertion == Insertion::kAngle) {
    const AngleDistribution& angles = phase.angles();
    if (!(confines.gamma.moment() > 0)) return std::nullopt;
    gamma = angles.sample(confines.gamma, to_double(u_gamma));
    theta = angles.sample_beyond(gamma, to_double(u_theta));
  } else if (insertion == Insertion::kGeometry) {
    theta = std::numbers::pi * std::sqrt(to_double(u_theta));
    gamma = to_double(u_gamma) * theta;
  } else {
    const float mu = phase.sample(u_theta);
    if (mu <= 0) return std::nullopt;
    theta = std::acos(std::min(to_double(mu), 1.0));
    gamma = to_double(u_gamma) * theta;
  }
  const double beta = theta - gamma, half_azimuth = confines.half_azimuth(gamma);
  InsertedCollision result;
  result.theta = static_cast<float>(theta);
  // Law of sines; angles and their sines are exact to the last digits, however small.
  const double sin_beta = std::sin(beta), cos_beta = std::cos(beta);
  const double sin_gamma = std::sin(gamma), cos_gamma = std::cos(gamma);
  const double scale = to_double(s) / (sin_beta * cos_gamma + cos_beta * sin_gamma);
  const double d1 = sin_gamma * scale, d2 = sin_beta * scale;
  result.d1 = static_cast<float>(d1);
  result.d2 = static_cast<float>(d2);
  if (!(result.d1 > 0) || !(result.d2 > 0) || !std::isfinite(result.d1 * result.d1) ||
      !std::isfinite(result.d2 * result.d2))
    return std::nullopt;

  const Vec3 forward = (x2.place - x0) / s;
  Vec3 aside = x2.cone.axis - forward * dot(x2.cone.axis, forward);
  const float tilt = length(aside);
  if (tilt > 1e-6f) {
    aside = aside / tilt;
    aside = normalize(aside - forward * dot(aside, forward));  // what the first step left over grew with 1 / tilt
  } else {
    aside = Frame(forward).s;
  }
  const auto phi = static_cast<float>((2 * to_double(u_phi) - 1) * half_azimuth);
  aside = aside * std::cos(phi) + cross(forward, aside) * std::sin(phi);
  result.arrives = forward * static_cast<float>(cos_beta) + aside * static_cast<float>(sin_beta);
  result.leaves = forward * static_cast<float>(cos_gamma) - aside * static_cast<float>(sin_gamma);
  // From the nearer end, whose rounding is smaller.
  result.position = d1 < d2 ? x0 + result.arrives * result.d1 : x2.place - result.leaves * result.d2;
  result.f = phase.eval_angle(result.theta);
  result.pdf_v = to_volume(pdf_of_angles(phase, insertion, confines, theta), half_azimuth, to_double(s), d1, d2);
  if (!(result.pdf_v > 0) || !std::isfinite(result.pdf_v)) return std::nullopt;
  return result;
}

double insertion_pdf_v(const PhaseFunction& phase, const Vec3& x0, const Vec3& x1, const PathEnd& x2,
                       Insertion insertion) {
  const Vec3 first = x1 - x0, second = x2.place - x1, line = x2.place - x0;
  const double s = to_double(length(line)), d1 = to_double(length(first)), d2 = to_double(length(second));
  if (!(s > 0) || !(d1 > 0) || !(d2 > 0)) return 0;
  const double theta = angle_between(first, second);
  if (!(theta > 0)) return 0;
  if (insertion == Insertion::kAngle && !x2.cone.contains(-second)) return 0;
  const Confines confines(phase, x2, x0, insertion);
  const double half_azimuth = confines.half_azimuth(angle_between(second, line));
  const double pdf = to_volume(pdf_of_angles(phase, insertion, confines, theta), half_azimuth, s, d1, d2);
  return std::isfinite(pdf) ? pdf : 0;
}

std::optional<InsertedCollision> insert_collision_towards(const PhaseFunction& phase, const Spectrum& sigma_t,
                                                          const Vec3& x0, const Vec3& direction, Insertion insertion,
                                                          float u_theta, float u_phi, float u_distance) {
  const float mu = insertion == Insertion::kGeometry ? 1 - 2 * u_theta : phase.sample(u_theta);
  const float choice = u_distance * kChannels;
  const int channel = std::min(static_cast<int>(choice), kChannels - 1);
  const float d1 = -std::log1p(-(choice - static_cast<float>(channel))) / sigma_t[channel];
  if (!(d1 > 0) || !std::isfinite(d1 * d1)) return std::nullopt;
  InsertedCollision result;
  result.arrives = direction_about(direction, mu, 2 * kPi * u_phi);
  result.leaves = direction;
  result.position = x0 + result.arrives * d1;
  result.d1 = d1;
  result.d2 = kInfinity;
  result.theta = std::acos(std::clamp(mu, -1.0f, 1.0f));
  result.f = phase.eval(mu);
  result.pdf_v = insertion_pdf_v_towards(phase, sigma_t, x0, result.position, direction, insertion);
  if (!(result.pdf_v > 0) || !std::isfinite(result.pdf_v)) return std::nullopt;
  return result;
}

double insertion_pdf_v_towards(const PhaseFunction& phase, const Spectrum& sigma_t, const Vec3& x0, const Vec3& x1,
                               const Vec3& direction, Insertion insertion) {
  const float d1 = length(x1 - x0);
  if (!(d1 > 0)) return 0;
  const float mu = dot(x1 - x0, direction) / d1;
  const float pdf_w = insertion == Insertion::kGeometry ? 1 / (4 * kPi) : phase.eval(mu);
  const double pdf = static_cast<double>(pdf_w) * static_cast<double>((sigma_t * exp(sigma_t * -d1)).mean()) /
                     sqr(static_cast<double>(d1));
  return std::isfinite(pdf) ? pdf : 0;
}

}  // namespace turbid
