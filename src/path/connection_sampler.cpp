#include "path/connection_sampler.h"

#include <cmath>

#include "medium/angle_distribution.h"
#include "path/join.h"

namespace turbid {
namespace {

/// In the weights the walk counts for less than its density: where it is as likely to make x1 as the others, its
/// estimate, which has neither the geometry term nor the phase function, varies more. Any factor is right.
constexpr double kWalkDiscount = 0.25;

/// A ray and the end of a path beside it. Places along the ray are told by the angle theta between the ray's direction
/// and the way from there to the end, from `beta` at distance 0 to pi at infinity: dt = d2^2 / height dtheta. Between
/// `from` and `to` they lie in the end's cone.
struct RayBesideEnd {
  double foot;    ///< distance to the foot of the perpendicular
  double height;  ///< its length
  double beta, from, to;

  RayBesideEnd(const Vec3& origin, const Vec3& direction, const PathEnd& end)
      : foot(static_cast<double>(dot(end.place - origin, direction))),
        height(static_cast<double>(length(cross(end.place - origin, direction)))),
        beta(std::atan2(height, foot)),
        from(beta),
        to(std::numbers::pi) {
    if (end.cone.is_everything() || end.cone.cosine < 0) return;
    cut(end.cone, origin - end.place, direction);
  }

  double theta(double t) const { return std::atan2(height, foot - t); }
  /// d1 = s sin(theta - beta) / sin(theta), height = s sin(beta); where the difference is small no digits are lost.
  double distance(double theta) const { return height * std::sin(theta - beta) / (std::sin(theta) * std::sin(beta)); }
  double dtheta_dt(double t) const { return height / (sqr(height) + sqr(foot - t)); }

 private:
  /// A cone of at most 90 degrees is convex: it keeps one piece of the ray p + t w, where
  /// a.(p + t w) >= cos |p + t w|, a the axis.
  void cut(const Cone& cone, const Vec3& p, const Vec3& w) {
    const auto number = [](float x) { return static_cast<double>(x); };
    const double ap = number(dot(cone.axis, p)), aw = number(dot(cone.axis, w)), pw = number(dot(p, w));
    const double square = sqr(cone.cosine);
    const double qa = sqr(aw) - square, qb = ap * aw - square * pw, qc = sqr(ap) - square * number(dot(p, p));
    double first = 0, last = std::numeric_limits<double>::infinity();
    const auto keep = [&](double begin, double end) {
      first = std::max(first, begin);
      last = std::min(last, end);
    };
    const double root2 = sqr(qb) - qa * qc;
    if (root2 > 0 && qa != 0) {
      const double root = std::sqrt(root2), q = -(qb + std::copysign(root, qb));
      const double low = std::min(q / qa, qc / q), high = std::max(q / qa, qc / q);
      if (qa < 0)
        keep(low, high);  // inside of the cone, or of its mirror image
      else if (aw > 0)
        keep(high, last);  // the cone lies ahead
      else
        keep(first, low);
      const double middle = std::isfinite(last) ? (first + last) / 2 : first + 1;
      if (!(first < last) || ap + middle * aw < 0) keep(1, 0);
    } else if (qa < 0 || ap < 0) {
      keep(1, 0);  // never inside
    }
    from = first < last ? theta(first) : std::numbers::pi;
    if (std::isfinite(last) && first < last) to = theta(last);
  }
};

}  // namespace

ConnectionSampler::ConnectionSampler(const Scene& scene, const ConnectionSettings& settings)
    : scene_(scene),
      technique_(scene.has_priorities() ? ConnectionTechnique::kStandard : settings.technique),
      insertion_(settings.insertion) {}

const Medium* ConnectionSampler::expected(const Medium* around) const {
  if (!active()) return nullptr;
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
  const RayBesideEnd ray(from.position, direction, end);
  if (!(ray.from < ray.to)) return std::nullopt;
  const auto number = static_cast<double>(u);
  const double theta = technique_ == ConnectionTechnique::kEquiangular
                           ? ray.from + number * (ray.to - ray.from)
                           : from.medium->phase().angles().sample_beyond(ray.from, number, ray.to);
  const auto t = static_cast<float>(ray.distance(theta));
  if (!(t > 0) || !std::isfinite(t * t)) return std::nullopt;
  const double pdf = pdf_t(from, direction, t, end);
  if (!(pdf > 0)) return std::nullopt;
  return Distance{t, pdf};
}

double ConnectionSampler::pdf_t(const Departure& from, const Vec3& direction, float t, const PathEnd& end) const {
  if (end.at_infinity) return 0;
  const RayBesideEnd ray(from.position, direction, end);
  if (!(ray.height > 0)) return 0;
  const auto distance = static_cast<double>(t);
  const double theta = ray.theta(distance);
  if (theta < ray.from || theta > ray.to) return 0;
  const double pdf_theta = technique_ == ConnectionTechnique::kEquiangular
                               ? 1 / (ray.to - ray.from)
                               : from.medium->phase().angles().pdf_beyond(ray.from, theta, ray.to);
  return pdf_theta * ray.dtheta_dt(distance);
}

CollisionDensities ConnectionSampler::densities(const Edge& edge, const PathEnd& end,
                                                std::optional<double> inserted) const {
  CollisionDensities result;
  const Departure& from = edge.from;
  if (!from.medium || !(edge.length > 0)) return result;
  const double by_direction = static_cast<double>(from.pdf_w) / sqr(static_cast<double>(edge.length));
  result.walk = kWalkDiscount * by_direction * end_factor(edge.sigma, 1, edge.proxy);
  if (marches(from)) result.along = by_direction * pdf_t(from, edge.direction, edge.length, end);
  if (inserted) {
    result.inserted = *inserted;
  } else if (inserts(from)) {
    const PhaseFunction& phase = from.medium->phase();
    const Vec3 x1 = from.position + edge.direction * edge.length;
    result.inserted = end.at_infinity ? insertion_pdf_v_towards(phase, from.medium->sigma_t(), from.position, x1,
                                                                end.place, insertion_)
                                      : insertion_pdf_v(phase, from.position, x1, end, insertion_);
  }
  return result;
}

bool ConnectionSampler::makes(const Edge& edge, const PathEnd& end) const {
  const Departure& from = edge.from;
  if (!from.medium || !(edge.length > 0)) return false;
  if (marches(from)) return pdf_t(from, edge.direction, edge.length, end) > 0;
  if (!inserts(from)) return false;
  const Vec3 x1 = from.position + edge.direction * edge.length;
  const float mu = dot(edge.direction, end.direction_from(x1));
  if (insertion_ == Insertion::kGeometry) return true;
  const bool forward_only = insertion_ == Insertion::kSolidAngle && !end.at_infinity;
  return (mu > 0 || !forward_only) && from.medium->phase().eval(mu) > 0 &&
         (end.at_infinity || forward_only || end.cone.contains(x1 - end.place));
}

double ConnectionSampler::weight(double own, const CollisionDensities& all) {
  const double sum = sqr(all.walk) + sqr(all.along) + sqr(all.inserted);
  return sum > 0 ? sqr(own) / sum : 0;
}

double ConnectionSampler::walk_weight(const Edge& edge, const PathEnd& end, double advantage) const {
  if (!weighs()) return makes(edge, end) ? 0 : 1;
  CollisionDensities all = densities(edge, end);
  if (all.along + all.inserted == 0) return 1;
  all.walk *= advantage;
  return weight(all.walk, all);
}

}  // namespace turbid
