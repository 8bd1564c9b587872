#include "refraction/pencil.h"

namespace turbid {

Pencil::Ray Pencil::ray(const V2d& at) const {
  Ray result;
  result.p = facet_.position(at);
  result.normal = facet_.normal(at);
  result.distance = 1;
  if (light_.at_infinity) {
    result.to_light = light_.place;
  } else {
    const V3d towards = light_.place - result.p;
    result.distance = std::sqrt(towards.length2());
    result.to_light = towards * (1 / result.distance);
  }
  result.cos_light = result.to_light.dot(result.normal);
  const double cos2 = 1 - (1 - sqr(result.cos_light)) * sqr(inverse_eta_);
  result.cos_refracted = cos2 > 0 ? std::sqrt(cos2) : 0;
  result.direction =
      result.normal * (result.cos_light * inverse_eta_ - result.cos_refracted) - result.to_light * inverse_eta_;
  return result;
}

Pencil::Differential Pencil::differential(const V2d& at) const {
  Differential result{ray(at), facet_.p_a, facet_.p_b, {}, {}};
  const Ray& r = result.ray;
  const V3d blended = facet_.blended_normal(at);
  const double bend = r.cos_light * inverse_eta_ - r.cos_refracted;
  const auto direction_change = [&](const V3d& dp, const V3d& dblend) {
    const V3d dn = Facet::normal_change(blended, dblend);
    const V3d dl = light_.at_infinity ? V3d(0) : -(dp - r.to_light * r.to_light.dot(dp)) / r.distance;
    const double dcos = dl.dot(r.normal) + r.to_light.dot(dn);
    const double dcos_refracted = r.cos_refracted > 0 ? r.cos_light * dcos * sqr(inverse_eta_) / r.cos_refracted : 0;
    return r.normal * (dcos * inverse_eta_ - dcos_refracted) + dn * bend - dl * inverse_eta_;
  };
  result.direction_a = direction_change(facet_.p_a, facet_.n_a);
  result.direction_b = direction_change(facet_.p_b, facet_.n_b);
  return result;
}

V2d meeting_gradient(const Pencil::Differential& there, const Line& line) {
  const V3d across = there.ray.direction.cross(line.direction), from_line = there.ray.p - line.origin;
  return {across.dot(there.p_a) + there.direction_a.cross(line.direction).dot(from_line),
          across.dot(there.p_b) + there.direction_b.cross(line.direction).dot(from_line)};
}

Encounter encounter(const Pencil::Ray& ray, const Line& line) {
  const V3d across = ray.direction.cross(line.direction), between = ray.p - line.origin;
  const double inverse = 1 / across.length2();
  // between = t d - s w + k across: the cross product with w leaves t, that with d leaves s.
  return {ray.direction.cross(between).dot(across) * inverse, line.direction.cross(between).dot(across) * inverse};
}

}  // namespace turbid
