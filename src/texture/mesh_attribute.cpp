#include "texture/mesh_attribute.h"

#include <stdexcept>

#include "geometry/triangle_mesh.h"

namespace turbid {

MeshAttributeTexture::MeshAttributeTexture(std::string name, float scale) : name_(std::move(name)), scale_(scale) {
  if (!name_.starts_with("vertex_") && !name_.starts_with("face_"))
    throw std::invalid_argument("the name of a mesh attribute begins with 'vertex_' or 'face_', found '" + name_ + "'");
}

Spectrum MeshAttributeTexture::eval(const SurfacePoint& point) const {
  const MeshAttribute* attribute = point.mesh ? point.mesh->attribute(name_) : nullptr;
  if (!attribute) return Spectrum(0.0f);
  const Vec3 value = point.mesh->eval_attribute(*attribute, point);
  return Spectrum(value.x, value.y, value.z) * scale_;
}

float MeshAttributeTexture::eval_scalar(const SurfacePoint& point) const {
  const Spectrum v = eval(point);
  return v.min() == v.max() ? v[0] : v.luminance();
}

}  // namespace turbid
