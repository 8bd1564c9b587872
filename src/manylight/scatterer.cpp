#include "manylight/scatterer.h"

namespace turbid {

Scatterer::Scatterer(const Vertex& vertex, TransportMode mode)
    : position_(vertex.position),
      normal_(0),
      other_normal_(0),
      given_(vertex.given),
      scale_(vertex.throughput),
      vertex_(&vertex),
      depth_(vertex.depth),
      order_(vertex.order),
      visit_order_(vertex.visit_order),
      mode_(mode) {
  if (!vertex.is_surface()) {
    kind_ = Kind::kCollision;
    medium_ = vertex.medium;
    phase_ = &vertex.medium->phase();
    return;
  }
  const SurfacePoint& point = vertex.point;
  normal_ = dot(vertex.given, point.ng) > 0 ? point.ng : -point.ng;
  const auto reflectance = vertex.object->bsdf->diffuse_reflectance(point, vertex.given_local);
  if (!reflectance) return;
  kind_ = Kind::kDiffuse;
  // Both normals must have the direction on the side of `given`. From the sensor f |cos| goes by the shading normal;
  // from a light adjoint_correction() makes it |cos_g(chosen)| |cos_s(given)| / |cos_g(given)|.
  const float given_s = vertex.given_local.z, given_g = dot(vertex.given, point.ng);
  const float side = given_s > 0 ? 1.0f : -1.0f;
  const bool from_light = mode == TransportMode::kImportance;
  normal_ = (from_light ? point.ng : point.shading.n) * side;
  other_normal_ = (from_light ? point.shading.n : point.ng) * side;
  scale_ *= *reflectance / kPi;
  if (from_light) scale_ *= given_s * given_g > 0 ? given_s / given_g : 0.0f;
}

float Scatterer::strength() const {
  // A phase function or a glossy lobe may be any multiple of this; what is right on average will do.
  constexpr float kIsotropic = 1 / (4 * kPi);
  return scale_.max() * (kind_ == Kind::kDiffuse ? 1 : kIsotropic);
}

}  // namespace turbid
