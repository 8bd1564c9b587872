#include "path/connection_sampler.h"

#include <cmath>

#include "medium/angle_distribution.h"
#include "path/join.h"

namespace turbid {
namespace {

/// A ray and a point beside it. Places along the ray are told by the angle theta between the ray's direction and the
/// way from there to the point, from beta at distance 0 to pi at infinity: dt = d2^2 / height dtheta.
struct RayBesidePoint {
  double foot;    ///< distance to the foot of the perpendicular
  double height;  ///< its length
  double beta;

  RayBesidePoint(const Vec3& origin, const Vec3& direction, const Vec3& point)
      : foot(static_cast<double>(dot(point - origin, direction))),
        height(static_cast<double>(length(cross(point - origin, direction)))),
        beta(std::atan2(height, foot)) {}

  double theta(double t) const { return std::atan2(height, foot - t); }
  /// d1 = s sin(theta - beta) / sin(theta), height = s sin(beta); where the difference is small no digits are lost.
  double distance(double theta) const { return height * std::sin(theta - beta) / (std::sin(theta) * std::sin(beta)); }
  double dtheta_dt(double t) const { return height / (sqr(height) + sqr(foot - t)); }
};

}  // namespace

ConnectionSampler::ConnectionSampler(const Scene& scene, const ConnectionSettings& settings)
    : scene_(scene),
      technique_(settings.technique),
      insertion_(settings.insertion),
      possible_(technique_ != ConnectionTechnique::kStandard && !scene.has_priorities()),
      equiangular_(technique_ == ConnectionTechnique::kEquiangular),
      inserts_(technique_ == ConnectionTechnique::kOnceMore || technique_ == ConnectionTechnique::kMis),
      marches_open_(technique_ != ConnectionTechnique::kOnceMore),
      marches_given_(true) {}

const Medium* ConnectionSampler::expected(const Medium* around) const {
  if (!possible_) return nullptr;
  return around ? around : scene_.thinnest_medium();
}

const Medium* ConnectionSampler::expected(const Object& object, const Medium* around) const {
  if (!around && object.bounds_media) around = object.interior ? object.interior.get() : object.exterior.get();
  return expected(around);
}

std::optional<InsertedCollision> ConnectionSampler::insert(const Departure& from, const PathEnd& end, float u_theta,
                                                           float u_beta, float u_phi) const {
  const PhaseFunction& phase = from.medium->phase();
  if (end.at_infinity)
    return insert_collision_towards(phase, from.medium->sigma_t(), from.position, end.place, insertion_, u_theta, u_phi,
                                    u_beta);
  return insert_collision(phase, from.position, end, insertion_, u_theta, u_beta, u_phi);
}

std::optional<ConnectionSampler::Distance> ConnectionSampler::march(const Departure& from, const Vec3& direction,
                                                                    const PathEnd& end, float u) const {
  if (end.at_infinity) return std::nullopt;
  const RayBesidePoint ray(from.position, direction, end.place);
  const auto number = static_cast<double>(u);
  const double theta = equiangular_ ? ray.beta + number * (std::numbers::pi - ray.beta)
                                    : from.medium->phase().angles().sample_beyond(ray.beta, number);
  const auto t = static_cast<float>(ray.distance(theta));
  if (!(t > 0) || !std::isfinite(t * t)) return std::nullopt;
  const double pdf = pdf_t(from, direction, t, end);
  if (!(pdf > 0)) return std::nullopt;
  return Distance{t, pdf};
}

double ConnectionSampler::pdf_t(const Departure& from, const Vec3& direction, float t, const PathEnd& end) const {
  if (end.at_infinity) return 0;
  const RayBesidePoint ray(from.position, direction, end.place);
  if (!(ray.height > 0)) return 0;
  const auto distance = static_cast<double>(t);
  const double pdf_theta = equiangular_ ? 1 / (std::numbers::pi - ray.beta)
                                        : from.medium->phase().angles().pdf_beyond(ray.beta, ray.theta(distance));
  return pdf_theta * ray.dtheta_dt(distance);
}

CollisionDensities ConnectionSampler::densities(const Departure& from, const Vec3& direction, float d1,
                                                const PathEnd& end, const Spectrum& sigma,
                                                const Spectrum& proxy) const {
  CollisionDensities result;
  if (!from.medium || !(d1 > 0)) return result;
  const Vec3 x1 = from.position + direction * d1;
  const double by_direction = static_cast<double>(from.pdf_w) / sqr(static_cast<double>(d1));
  result.walk = by_direction * end_factor(sigma, 1, proxy);
  if (marches(from)) result.along = by_direction * pdf_t(from, direction, d1, end);
  if (inserts(from)) {
    const PhaseFunction& phase = from.medium->phase();
    result.inserted = end.at_infinity ? insertion_pdf_v_towards(phase, from.medium->sigma_t(), from.position, x1,
                                                                end.place, insertion_)
                                      : insertion_pdf_v(phase, from.position, x1, end, insertion_);
  }
  return result;
}

double ConnectionSampler::weight(double own, const CollisionDensities& all) const {
  if (technique_ != ConnectionTechnique::kMis) return 1;
  const double sum = sqr(all.walk) + sqr(all.along) + sqr(all.inserted);
  return sum > 0 ? sqr(own) / sum : 0;
}

double ConnectionSampler::walk_weight(const CollisionDensities& all) const {
  if (all.along + all.inserted == 0) return 1;
  return technique_ == ConnectionTechnique::kMis ? weight(all.walk, all) : 0;
}

}  // namespace turbid
