#include "refraction/distance_factor.h"

namespace turbid {

double distance_factor(const Facet& facet, const RefractedPath& path) {
  const V3d from_v = path.p - path.v;
  const double distance_v = from_v.length();
  const V3d e = from_v / distance_v;  // of the ray from V
  const V3d towards = path.light.at_infinity ? path.light.place : path.light.place - path.p;
  const double distance_l = path.light.at_infinity ? 0 : towards.length();
  const V3d w = towards.normalized();
  const V3d& n = path.normal;
  // w = eta e + bend n, bend = cos_L - eta cos_V.
  const double cos_v = e.dot(n), cos_l = w.dot(n), bend = cos_l - path.eta * cos_v;
  const V3d blended = facet.blended_normal(path.at);
  const V3d across = facet.p_a.cross(facet.p_b);
  const auto arrival_change = [&](const V3d& de) {
    const V3d dp = (de - e * (de.dot(facet.ng) / e.dot(facet.ng))) * distance_v;
    const double da = dp.cross(facet.p_b).dot(across) / across.length2();
    const double db = facet.p_a.cross(dp).dot(across) / across.length2();
    const V3d dn = Facet::normal_change(blended, facet.n_a * da + facet.n_b * db);
    const double dcos_v = de.dot(n) + e.dot(dn);
    // cos_L^2 = 1 - eta^2 (1 - cos_V^2)
    const double dcos_l = sqr(path.eta) * cos_v * dcos_v / cos_l;
    const V3d dw = de * path.eta + n * (dcos_l - path.eta * dcos_v) + dn * bend;
    return path.light.at_infinity ? dw : dp + dw * distance_l;
  };
  const V3d helper = std::abs(e.x) < 0.6 ? V3d(1, 0, 0) : V3d(0, 1, 0);
  const V3d u = e.cross(helper).normalized();
  return std::abs(arrival_change(u).cross(arrival_change(e.cross(u))).dot(w));
}

double flat_distance_factor(double distance_v, double distance_l, double cos_v, double cos_l, double eta) {
  return (distance_v + eta * distance_l) * (cos_l / cos_v * distance_v + eta * cos_v / cos_l * distance_l);
}

}  // namespace turbid
